"""``import_competition DIR --world NAME``: imports the folder of a competition since 2024."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.competition_import import import_competition
from annotations.management.base import ImportCommand, RefusedReport


class Command(ImportCommand):
    help = (
        "Imports names, rooms, locations and objects from the Markdown folder of a competition. What the world has of "
        "these is replaced; grammar and templates stay. Says which rows the published generators lose, and what "
        "grammar and templates ask for that no entity is. Refused whole where a file has an error."
    )

    audited = "import files"

    def add_options(self, parser: CommandParser) -> None:
        super().add_options(parser)
        parser.add_argument(
            "--arena",
            default="",
            help="whose files are taken where the folder has those of several",
        )

    def report(
        self,
        *,
        folder: Path,
        world: str,
        bring_back: bool,
        encoding: str,
        arena: str,
        **options: Any,
    ) -> Mapping[str, Any]:
        report = import_competition(
            world, folder, brings_back=bring_back, encoding=encoding, arena=arena
        )
        if report.is_waiting:
            names = ", ".join(report.arenas)
            sentence = f"The folder has files of several arenas: {names}. Choose one with --arena."
            raise RefusedReport(report.as_json(), [f"{sentence} Nothing was imported."])
        if report.is_refused:
            raise RefusedReport.because(report.errors, report.as_json(), folder)
        return report.as_json()
