"""Verbs: download a world as one zip archive, and make the same world again from it, row for row;
normalise the texts that a world has stored.

The archive holds ``world.json`` (what it is, in which version of the format, how many rows of each
kind), ``rows/*.jsonl`` (everything, one row a line, references by line number), and the same once more
for people and other programs: ``generator/`` (the files of a command generator with
``predicates.json`` and paraphrases) and ``splits/`` (pair files). An import reads the rows.
"""
