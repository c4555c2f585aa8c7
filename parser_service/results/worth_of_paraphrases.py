"""What paraphrases are worth: accuracy on what people say, by the number of paraphrases that a parser learned from."""

from __future__ import annotations

import json
from collections import defaultdict
from functools import cache
from pathlib import Path
from typing import Any

from annotations.generation.split_statistics import figures_of
from annotations.language.corpus import Criterion
from annotations.models import World
from annotations.models.background import Status
from annotations.models.splits import Source
from parser_service.models import Evaluation
from parser_service.parsers.conditions import PARAPHRASED, sources_of
from parser_service.parsers.registry import title_of

MEASURED = Path(__file__).with_suffix(".json")  # by benchmarks/parsing/worth_of_paraphrases.py
MOST_READ = 200  # the newest evaluations

Point = tuple[int, float, float, float]
"""Number of paraphrases; percent, with the ends of its 95 % interval."""


@cache
def measured_elsewhere() -> dict[str, Any]:
    """Return the curve of the published pairs: ``chart``, and what it was measured on."""
    measured = json.loads(MEASURED.read_text("utf-8"))
    return {**measured, "chart": _chart(measured["parser"], measured["points"])}


def measured_here(world: World) -> dict[str, Any] | None:
    """Return the curve of the parser of ``world`` whose runs learned from most different numbers of paraphrases.

    Those of splits by form, which ask for something else, are left out. None where no parser has two numbers.
    """
    scores = Evaluation.objects.filter(
        run__world=world, run__status=Status.SUCCEEDED, part="validation", test_source="para"
    ).exclude(run__split__criterion=Criterion.LOGICAL_FORM)
    rows = scores.select_related("run__split").defer("outcomes").order_by("-run_id")[:MOST_READ]
    curves: dict[str, dict[int, Point]] = defaultdict(dict)
    for row in rows:
        number = round(_paraphrases_in(row) * row.run.train_share)
        ends = row.accuracy, row.interval_low, row.interval_high
        percent, low, high = (round(100 * each, 1) for each in ends)
        curves[row.run.parser].setdefault(number, (number, percent, low, high))
    parser = max(curves, key=lambda name: len(curves[name]), default="")
    if len(curves.get(parser, ())) < 2:
        return None
    return {"parser": parser, "chart": _chart(parser, sorted(curves[parser].values()))}


def _paraphrases_in(score: Evaluation) -> int:
    """Return how many paraphrases the training part has that the run of ``score`` could learn from."""
    if PARAPHRASED not in sources_of(score.run.train_sources):
        return 0
    counts = figures_of(score.run.split).counts
    return sum(each.train for each in counts if each.source == Source.PARAPHRASED)


def _chart(parser: str, points: list[Point]) -> dict[str, Any]:
    return {
        "kind": "points",
        "x": {"label": "paraphrases to learn from"},
        "y": {"label": "right", "max": 100, "unit": "%"},
        "series": [{"name": title_of(parser), "points": points}],
        "done": True,
    }
