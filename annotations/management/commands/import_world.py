"""``import_world FILE --world W``: makes the world of an archive again."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.world_import import import_world
from annotations.management.base import ReportingCommand


class Command(ReportingCommand):
    help = (
        "Makes a world from an archive that export_world or the page Download wrote: the same rows "
        "under another name. Refused whole where anything is wrong with the archive."
    )

    audited = "import a world"

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("file", type=Path)
        parser.add_argument("--world", required=True, help="the name of the new world")

    def report(self, *, file: Path, world: str, **options: Any) -> Mapping[str, Any]:
        return import_world(world, file).as_json()

    def audit_subject(self, report: Mapping[str, Any], options: Mapping[str, Any]) -> str:
        return str(options["file"].name)
