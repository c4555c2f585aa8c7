"""Verbs: download a world as one zip archive, and make the same world again from it, row for row.

The archive holds ``world.json`` (what it is, in which version of the format, how many rows of each
kind), ``rows/*.jsonl`` (everything, one row a line, references by line number), and the same once more
for people and other programs: ``generator/`` (the files of a command generator with
``predicates.json`` and paraphrases) and ``splits/`` (pair files). An import reads the rows.
"""

from annotations.world_archive.reading import ImportedWorld, import_world
from annotations.world_archive.tables import Table
from annotations.world_archive.writing import archive_name, world_archive

__all__ = ["ImportedWorld", "Table", "archive_name", "import_world", "world_archive"]
