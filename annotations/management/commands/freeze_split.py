"""``freeze_split W --name N``: freezes a world's commands and paraphrases as splits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from django.core.management.base import CommandError, CommandParser
from django.db import transaction

from annotations.generation.freezing import as_items, freeze_split, unresolved_prompts
from annotations.generation.split_statistics import figures_of
from annotations.language.corpus import Criterion
from annotations.management.base import ReportingCommand, find_world
from annotations.models import Split
from annotations.rows.synchronise import BATCH


class Command(ReportingCommand):
    help = (
        "Freezes the commands and accepted paraphrases of a world as splits. With several criteria "
        "each split is named NAME-CRITERION."
    )

    audited = "freeze a split"

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument("--name", required=True)
        parser.add_argument(
            "--criterion", default="command", help=f"any of {','.join(Criterion)}, by commas"
        )
        parser.add_argument("--seed", type=int, default=0)
        parser.add_argument(
            "--parts", default="70,10,20", help="percentages of train, validation and test"
        )
        parser.add_argument(
            "--tests-on-models",
            action="store_true",
            help="put what language models wrote into validation and test too",
        )

    def report(
        self,
        *,
        world: str,
        name: str,
        criterion: str,
        seed: int,
        parts: str,
        tests_on_models: bool,
        **options: Any,
    ) -> Mapping[str, Any]:
        chosen = find_world(world)
        criteria = list(dict.fromkeys(each.strip() for each in criterion.split(",")))
        for each in criteria:
            if each not in set(Criterion):
                raise CommandError(f"“{each}” is no criterion. There are: {', '.join(Criterion)}.")
        names = {each: name if len(criteria) == 1 else f"{name}-{each}" for each in criteria}
        try:
            shares = [float(each) / 100 for each in parts.split(",")]
        except ValueError:
            sentence = f"“{parts}” is not three percentages, such as 70,10,20."
            raise CommandError(sentence) from None
        with transaction.atomic():
            splits = [
                freeze_split(
                    chosen, names[each], each, seed, shares, tests_on_models=tests_on_models
                )
                for each in criteria
            ]
        return {"world": world, "splits": _describe(splits)}

    def audit_subject(self, report: Mapping[str, Any], options: Mapping[str, Any]) -> str:
        return ", ".join(each["name"] for each in report["splits"])


def _describe(splits: Sequence[Split]) -> list[dict[str, Any]]:
    described = []
    for split in splits:
        row: dict[str, Any] = {
            name: getattr(split, name) for name in ("name", "criterion", "seed", "content_hash")
        }
        if split.criterion == Criterion.SOURCE_COMMAND:
            # Prompts that are no generated command: their paraphrases went to the training part.
            items = as_items(split.examples.order_by().iterator(chunk_size=BATCH))
            row["unresolved_prompts"] = sorted(unresolved_prompts(items).values())
        row["counts"] = {
            each.source: {key: value for key, value in asdict(each).items() if key != "source"}
            for each in figures_of(split).counts
        }
        described.append(row)
    return described
