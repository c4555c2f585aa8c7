"""Verb: take files in. All or nothing; a second import of the same files changes nothing."""

from annotations.importing.generators import import_generator
from annotations.importing.report import ImportReport, as_json

__all__ = ["ImportReport", "as_json", "import_generator"]
