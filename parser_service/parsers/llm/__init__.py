"""A language model behind an HTTP server, asked with the nearest training pairs as examples.

``config`` and ``places`` are what pages read. ``prompts`` says what is sent, ``protocol`` how servers
write it, ``exchange`` carries one request, ``asking`` asks until an answer comes, and ``answers`` keeps it.
"""
