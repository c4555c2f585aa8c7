"""Answer utterances with trained parsers, in this process or by the parse server.

``loading`` and ``choosing`` find the parser of a run, ``preparing`` is the one way from a text to what a
parser is given, and ``answers`` the one way back. ``shelf``, ``batching``, ``watching`` and ``application``
make up the parse server; ``client`` is how everybody else asks it.
"""
