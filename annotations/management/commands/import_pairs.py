"""``import_pairs DIR --world W --name N``: takes published pairs in."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.importing import import_pairs
from annotations.management.base import (
    Refused,
    ReportingCommand,
    add_brings_back,
    say_left_out,
)

MOST_BYTES = 2_000_000_000  # of a file; takes some six times as much memory


class Command(ReportingCommand):
    help = (
        "Imports the splits gen, para, gen_logical and para_logical of a folder, as the splits "
        "NAME-command and NAME-logical_form, and the paraphrases of paraphrasings.txt."
    )

    audited = "import pairs"

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("folder", type=Path)
        parser.add_argument("--world", required=True, help="made where there is none")
        parser.add_argument("--name", required=True, help="what the splits are called")
        add_brings_back(parser)

    def report(
        self, *, folder: Path, world: str, name: str, bring_back: bool, **options: Any
    ) -> Mapping[str, Any]:
        report = import_pairs(world, name, folder, brings_back=bring_back, most_bytes=MOST_BYTES)
        if report.is_refused:
            raise Refused.because(report.errors, report.as_json(), folder)
        return report.as_json()

    def audit_subject(self, report: Mapping[str, Any], options: Mapping[str, Any]) -> str:
        return f"{options['name']}, from {options['folder']}"

    def describe(self, report: Mapping[str, Any]) -> str:
        return "\n".join([super().describe(report), *say_left_out(report)])
