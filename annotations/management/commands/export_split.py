"""``export_split W NAME --as txt|jsonl|csv|parquet|zip|datasets --output PATH``: exports a frozen split."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.split_export import SplitFormat, export_split
from annotations.labelling.label_changes import examples_before
from annotations.management.base import ReportingCommand, find_split, find_world


class Command(ReportingCommand):
    help = "Writes a split as a folder of pair files (txt) or of a data set (datasets), or as one file (the rest)."

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument("name")
        parser.add_argument("--as", dest="as_", choices=SplitFormat.values, default=SplitFormat.TXT)
        parser.add_argument(
            "--output", type=Path, required=True, help="a folder (txt, datasets) or file"
        )

    def report(
        self, *, world: str, name: str, as_: str, output: Path, **options: Any
    ) -> Mapping[str, Any]:
        split = find_split(find_world(world), name)
        return {
            "split": split.name,
            "criterion": split.criterion,
            "content_hash": split.content_hash,
            "pairs_found_wrong_since": examples_before(split).count(),
            "files": export_split(split, as_, output),
        }
