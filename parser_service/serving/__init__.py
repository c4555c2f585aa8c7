"""Answer utterances with trained parsers, in this process or by the parse server.

``loading`` and ``default_runs`` find the parser of a run, ``preparing`` is the one way from a text to what a
parser is given, and ``parse_answers`` the one way back. ``shelf``, ``batching`` and ``application``
make up the parse server; ``parser_client`` is how everybody else asks it. ``lines`` answers JSON lines, for the parse
server and for the jobs of ``batch_requests`` and ``batch_job``; ``line_files`` answers those of a file or a pipe.
"""
