"""``restore FILE``: makes an installation from a backup."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.management.base import ReportingCommand
from gpsr_site.backup.backup_reading import restore


class Command(ReportingCommand):
    help = (
        "Fills an empty installation from a file that backup wrote: all of it, or nothing. Stop the "
        "site and its workers first."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("file", type=Path)
        parser.add_argument(
            "--replace", action="store_true", help="delete everything that is here first"
        )

    def report(self, *, file: Path, replace: bool, **options: Any) -> Mapping[str, Any]:
        manifest = restore(file, replace, self.stderr.write)
        return {
            "created_at": manifest.created_at,
            "rows": sum(part.rows or 0 for part in manifest.tables.values()),
            "files": len(manifest.files),
            "missing": manifest.missing,
        }
