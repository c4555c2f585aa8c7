"""``generate_pairs NAME``: makes the commands of a world, with their logical forms."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError, CommandParser

from annotations.generation.generating import generate_pairs
from annotations.generation.grounded_pairs import grounded_pairs
from annotations.language.corpus import by_length, write_pairs
from annotations.language.templates import (
    DEFAULT_LIMIT,
    LARGEST_SEED,
    MOST_SAMPLED,
    Balance,
    SampleRequest,
)
from annotations.management.base import ReportingCommand, find_world


class Command(ReportingCommand):
    help = "Generates the commands of a world, with their logical forms, from its templates."

    audited = "generate commands"

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument("--limit", type=int, default=DEFAULT_LIMIT, help="refuse more commands")
        parser.add_argument("--output", type=Path, help="write a pair file")
        parser.add_argument(
            "--grounded", type=int, metavar="N", help="write N grounded pairs instead of all"
        )
        parser.add_argument(
            "--sample",
            type=int,
            metavar="N",
            help="draw N commands instead of all; 0 makes all again",
        )
        parser.add_argument(
            "--balanced",
            choices=[each.value for each in Balance],
            help="of what the sample has equally many (none)",
        )
        parser.add_argument(
            "--seed", type=int, default=0, help="of the sample and the grounded pairs"
        )

    def report(
        self,
        *,
        world: str,
        limit: int,
        output: Path | None,
        grounded: int | None,
        sample: int | None,
        balanced: str | None,
        seed: int,
        **options: Any,
    ) -> Mapping[str, Any]:
        if grounded is not None and (grounded < 1 or output is None):
            raise CommandError("--grounded takes a number above 0, and --output for its file.")
        if balanced is not None and not sample:
            raise CommandError("--balanced takes --sample for the number of commands.")
        if sample is not None and not 0 <= sample <= MOST_SAMPLED:
            raise CommandError(f"--sample takes a number from 0 to {MOST_SAMPLED:,}.")
        if not 0 <= seed <= LARGEST_SEED:
            raise CommandError(f"--seed takes a number from 0 to {LARGEST_SEED}.")
        request = None
        if sample is not None:
            request = SampleRequest(sample, seed, Balance(balanced or Balance.NONE))
        chosen = find_world(world)
        report = generate_pairs(chosen, limit, request=request).as_json()
        if output is None:
            return report
        pairs = (
            grounded_pairs(chosen, grounded, seed)
            if grounded
            else list(chosen.commands.values_list("anonymized_text", "logical_form__text"))
        )
        with output.open("w", encoding="utf-8", newline="") as file:
            file.writelines(write_pairs(by_length(pairs)))
        return {**report, "output": {"path": str(output), "pairs": len(pairs)}}
