"""``compare_plans W``: compares the plans of the answers of all runs, by the recipes that the world has now."""

from __future__ import annotations

from collections.abc import Mapping
from http import HTTPStatus
from typing import Any

from django.core.management.base import CommandParser

from annotations.background.progress import UNWATCHED
from annotations.language.texts import Refusal
from annotations.management.base import ReportingCommand, find_world
from parser_service.reviews.plan_comparison import compare_plans


class Command(ReportingCommand):
    help = (
        "Says of each answer whether it has the plan of its label, by the recipes that the world has now: for runs "
        "that were scored before plans were compared, and after recipes have changed."
    )
    audited = "compare plans"

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument("--run", type=int, help="the number of one run; all without it")

    def report(self, *, world: str, run: int | None, **options: Any) -> Mapping[str, Any]:
        runs = find_world(world).runs.succeeded().select_related("world", "split").order_by("pk")
        chosen = list(runs if run is None else runs.filter(pk=run))
        if run is not None and not chosen:
            raise Refusal(
                f"There is no run {run} in {world} that has succeeded.",
                "no_such_run",
                HTTPStatus.NOT_FOUND,
            )
        changed = {str(each.pk): compare_plans(each, UNWATCHED) for each in chosen}
        return {"world": world, "runs": len(chosen), "changed": changed}
