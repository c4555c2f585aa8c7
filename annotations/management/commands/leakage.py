"""``leakage W NAME``: what the parts of a frozen split share with training."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from django.core.management.base import CommandParser

from annotations.generation.split_statistics import figures_of, near_duplicates_of
from annotations.management.base import ReportingCommand, find_split, find_world


class Command(ReportingCommand):
    help = (
        "Counts the pairs of the validation and test parts whose utterance, source command or logical "
        "form training has too, and those whose utterance it nearly has."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument("name")
        parser.add_argument(
            "--examples", type=int, default=20, help="near duplicates to list a part, nearest first"
        )

    def report(self, *, world: str, name: str, examples: int, **options: Any) -> Mapping[str, Any]:
        split = find_split(find_world(world), name)
        near = near_duplicates_of(split, limit=None)
        return {
            "split": split.name,
            "criterion": split.criterion,
            "shared": [
                {**asdict(leak), "share": round(leak.share, 4)}
                for leak in [*figures_of(split).leaks, *(each.leak for each in near)]
            ],
            "near_duplicates": {
                each.leak.part: [asdict(pair) for pair in each.duplicates[: max(examples, 0)]]
                for each in near
            },
        }

    def describe(self, report: Mapping[str, Any]) -> str:
        lines = [f"{report['split']}, by {report['criterion']}; also in training:"]
        for row in report["shared"]:
            counts = f"{row['shared']:>6} of {row['pairs']:>6}  {row['share']:6.1%}"
            lines.append(f"  {row['part']:10}  {row['what']:15}  {counts}")
        for part, pairs in report["near_duplicates"].items():
            for each in pairs:
                lines += [
                    f"{part}: {each['utterance']}",
                    f"  {each['similarity']:.2f}: {each['training']}",
                ]
        return "\n".join(lines)
