"""The server of a language model: ``protocol`` says how requests are written, ``exchange`` carries one, ``asker`` asks
until an answer comes, and ``kept_answers`` keeps it."""
