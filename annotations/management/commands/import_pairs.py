"""``import_pairs DIR --world W --name N``: imports published pairs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.pair_files import Notation
from annotations.exchange.pair_import import import_pairs
from annotations.management.base import ImportCommand, RefusedReport

MOST_BYTES = 2_000_000_000  # of a file; takes some six times as much memory


class Command(ImportCommand):
    help = (
        "Imports the splits gen, para, gen_logical and para_logical of a folder, as the splits "
        "NAME-command and NAME-logical_form, and the paraphrases of paraphrasings.txt."
    )

    audited = "import pairs"

    def add_options(self, parser: CommandParser) -> None:
        super().add_options(parser)
        parser.add_argument("--name", required=True, help="what the splits are called")
        parser.add_argument(
            "--notation",
            choices=[str(Notation.LAMBDA)],
            default=Notation.OURS,
            help="lambda: train, dev and test (.txt, .tsv) of another λ-corpus, read as far as possible",
        )

    def report(
        self,
        *,
        folder: Path,
        world: str,
        name: str,
        bring_back: bool,
        encoding: str,
        notation: str,
        **options: Any,
    ) -> Mapping[str, Any]:
        report = import_pairs(
            *(world, name, folder),
            brings_back=bring_back,
            most_bytes=MOST_BYTES,
            encoding=encoding,
            notation=notation,
        )
        if report.is_refused:
            raise RefusedReport.because(report.errors, report.as_json(), folder)
        return report.as_json()

    def audit_subject(self, report: Mapping[str, Any], options: Mapping[str, Any]) -> str:
        return f"{options['name']}, from {options['folder']}"
