"""``import_generator DIR --world NAME``: takes a command generator in."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.importing import import_generator
from annotations.management.base import Refused, ReportingCommand


class Command(ReportingCommand):
    help = (
        "Imports a folder of grammars, ontology files and semantic templates into a world. "
        "Refused whole, with exit status 1, where a file has an error."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("folder", type=Path)
        parser.add_argument("--world", required=True, help="made where there is none")

    def report(self, *, folder: Path, world: str, **options: Any) -> Mapping[str, Any]:
        report = import_generator(world, folder)
        if report.is_refused:
            raise Refused.because(report.errors, report.as_json())
        return report.as_json()
