"""``backup FILE``: writes a whole installation into one file while it runs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.management.base import ReportingCommand
from gpsr_site.backup.backup_writing import write_backup


class Command(ReportingCommand):
    help = (
        "Writes all rows and the files of all runs into one file, which restore reads into SQLite or "
        "PostgreSQL. The site may run meanwhile. Keep the file safe: it holds hashes of passwords."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("file", type=Path)

    def report(self, *, file: Path, **options: Any) -> Mapping[str, Any]:
        manifest = write_backup(file, self.stderr.write)
        return {
            "file": str(file),
            "bytes": file.stat().st_size,
            "rows": sum(part.rows or 0 for part in manifest.tables.values()),
            "files": len(manifest.files),
            "missing": manifest.missing,
        }
