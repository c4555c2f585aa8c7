"""Verb: take files in. All or nothing; a second import of the same files changes nothing."""

from annotations.importing.generators import import_generator
from annotations.importing.pairs import PairsReport, import_pairs
from annotations.importing.report import ImportReport

__all__ = ["ImportReport", "PairsReport", "import_generator", "import_pairs"]
