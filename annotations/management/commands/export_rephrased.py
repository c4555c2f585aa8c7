"""``export_rephrased W --as chat|pairs|tests``: what people say for commands, with plans in the team's primitives."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.rephrased_export import RephrasedExport, RephrasedFormat
from annotations.language.corpus import Part
from annotations.management.base import ReportingCommand, find_split, find_world


class Command(ReportingCommand):
    help = (
        "Writes the accepted paraphrases of a world with their plans in the primitives of its recipes, as JSON Lines: "
        "to fine-tune a chat model, to train on pairs, or to test with."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument(
            "--as", dest="as_", choices=RephrasedFormat.values, default=RephrasedFormat.CHAT
        )
        parser.add_argument("--split", help="only what is in a part of this split")
        parser.add_argument(
            "--part", choices=list(map(str, Part)), help="of the split; train by default"
        )
        parser.add_argument(
            "--output", type=Path, help="the file to write; W-chat.jsonl by default"
        )

    def report(
        self,
        *,
        world: str,
        as_: str,
        split: str | None,
        part: str | None,
        output: Path | None,
        **options: Any,
    ) -> Mapping[str, Any]:
        exported = find_world(world)
        of_split = find_split(exported, split) if split else None
        export = RephrasedExport(exported, exported.paraphrases.all(), as_, of_split, part)
        path = output or Path(export.file_name)
        with path.open("wb") as file:
            file.writelines(export.pieces())
        return {
            "world": world,
            "split": of_split and of_split.name,
            "part": export.part,
            "output": str(path),
            "cases": export.cases,
            "left_out": export.left_out,
        }
