"""A whole installation as one file, and back: all rows in a form that no database owns, and all files."""

from gpsr_site.backup.reading import restore
from gpsr_site.backup.writing import write_backup

__all__ = ["restore", "write_backup"]
