"""``import_generator DIR --world NAME``: imports a command generator."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.generator_import import import_generator
from annotations.management.base import ImportCommand, RefusedReport

MOST_LISTED = 40


class Command(ImportCommand):
    help = (
        "Imports a folder of grammars, ontology files and semantic templates into a world. "
        "Refused whole, with exit status 1, where a file has an error."
    )

    audited = "import files"

    def add_options(self, parser: CommandParser) -> None:
        super().add_options(parser)
        parser.add_argument(
            "--remove-missing",
            action="store_true",
            help="remove what the world has and the files do not; refused without it",
        )

    def report(
        self,
        *,
        folder: Path,
        world: str,
        remove_missing: bool,
        bring_back: bool,
        encoding: str,
        **options: Any,
    ) -> Mapping[str, Any]:
        report = import_generator(
            world, folder, may_remove=remove_missing, brings_back=bring_back, encoding=encoding
        )
        if report.is_waiting:
            removals = report.removals.as_json().items()
            lines = [f"  {name}: {text}" for name, texts in removals for text in texts]
            rest = [f"  and {len(lines) - MOST_LISTED} more"] if len(lines) > MOST_LISTED else []
            sentences = [
                f"The files lack rows that “{world}” has:",
                *lines[:MOST_LISTED],
                *rest,
                "Nothing was imported. With --remove-missing these are removed.",
            ]
            raise RefusedReport(report.as_json(), sentences)
        if report.is_refused:
            raise RefusedReport.because(report.errors, report.as_json(), folder)
        return report.as_json()
