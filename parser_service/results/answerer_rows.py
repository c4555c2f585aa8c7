"""The figures of a world's answerer as pages, files and scripts show them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from annotations.language.texts import say_count
from annotations.models import Split, World
from parser_service.analysis.probabilities import Reliability, reliability
from parser_service.models import AnswererEvaluation
from parser_service.models.answering import AnsweringOrder, answering_of
from parser_service.parsers.conditions import TEST_SOURCES, in_words
from parser_service.results.answerer_figures import FIGURES
from parser_service.serving.default_runs import EVIDENCE

# Figure → the head of its column, and what is counted.
LABELS = {
    "correct": ("Exact", "answers have exactly the form of the label"),
    "same_plan": ("Same plan", "answers make the robot do what was meant"),
    "acted": ("Acts", "commands are carried out at once"),
    "wrong_acts": ("Wrong acts", "commands that are carried out at once meant something else"),
    "confirmed": ("Confirms", "commands are repeated first: “Shall I …?”"),
    "asked": ("Asks", "commands are answered with a question"),
    "refused": ("Refuses", "commands are refused"),
}


@dataclass(frozen=True, slots=True)
class AnswererFigure:
    """One share of the answers, in percent, with the ends of its 95 % interval. ``percent`` is None where there is
    nothing that it could be a share of."""

    name: str
    label: str
    sentence: str
    percent: float | None = None
    low: float = 0.0
    high: float = 0.0


@dataclass(frozen=True, slots=True)
class ShownAnswerer:
    """What the answerer gave on one source of one part of a split."""

    row: AnswererEvaluation

    @property
    def source(self) -> str:
        return in_words(self.row.test_source)

    @property
    def figures(self) -> list[AnswererFigure]:
        return [figure_of(self.row, name) for name in LABELS]


def figure_of(row: AnswererEvaluation, name: str) -> AnswererFigure:
    """Return one of ``FIGURES`` of a row."""
    label, counted = LABELS[name]
    right, whole = getattr(row, name), getattr(row, FIGURES[name])
    if not whole:
        return AnswererFigure(name, label, "No command is carried out at once")
    low, high = (100 * end for end in row.intervals[name])
    return AnswererFigure(
        name, label, f"{right:,} of {whole:,} {counted}", 100 * right / whole, low, high
    )


@dataclass(frozen=True, slots=True)
class AnswererTable:
    """The newest measurement of a world's answerer on one part of one split, a row for each source."""

    split: Split
    part: str
    rows: tuple[ShownAnswerer, ...]
    is_outdated: bool  # grammar or templates have changed since

    @property
    def first(self) -> ShownAnswerer:
        """The row that says most about what a robot gets: what people say, else what comes nearest to it."""
        return min(self.rows, key=lambda each: EVIDENCE.index(each.row.test_source))

    @property
    def slug(self) -> str:
        """Tells its parts apart on a page."""
        return str(self.split.pk)

    @property
    def order(self) -> str:
        """Which parts answered, in words."""
        return AnsweringOrder(self.first.row.order).label

    @property
    def allowed_percent(self) -> float:
        return 100 * float(self.first.row.calibration["allowed_wrong"])

    @property
    def act_percent(self) -> float:
        """From which probability on it acts, in percent."""
        return 100 * float(self.first.row.calibration["point"]["act"])

    @property
    def examples(self) -> int:
        """How many utterances of people calibrated the probabilities."""
        return int(self.first.row.calibration["examples"])

    @property
    def calibrated_on(self) -> str:
        if not self.examples:
            return "Nobody’s utterances calibrate its probabilities yet: what a learned parser says is confirmed."
        return f"{say_count(self.examples, 'utterance')} of people calibrate its probabilities."

    @property
    def reliability(self) -> Reliability | None:
        return reliability_of([self.first.row])

    @property
    def chart(self) -> dict[str, Any] | None:
        return reliability_chart(self.reliability) if self.reliability else None


def answerer_tables(world: World, splits: Iterable[Split], part: str) -> list[AnswererTable]:
    """Return the newest measurement on ``part`` of each of ``splits`` that somebody has measured on.

    Of several orders that were measured it is the one that the world has chosen now. Three queries.
    """
    measured = AnswererEvaluation.objects.filter(
        world=world, split__in=list(splits), part=part, order=answering_of(world).order
    )
    of_split: dict[Split, list[AnswererEvaluation]] = defaultdict(list)
    for row in measured.select_related("split", "run").order_by("-made_at"):
        if not of_split[row.split] or of_split[row.split][0].made_at == row.made_at:
            of_split[row.split].append(row)
    revision = World.objects.values_list("revision", flat=True).get(pk=world.pk)
    sources = list(TEST_SOURCES)
    return [
        AnswererTable(
            split,
            part,
            tuple(map(ShownAnswerer, sorted(rows, key=lambda row: sources.index(row.test_source)))),
            any(row.revision != revision for row in rows),
        )
        for split, rows in of_split.items()
    ]


def newest_answerer_table(world: World) -> AnswererTable | None:
    """Return the newest measurement of the world on a validation part: what the overview shows."""
    rows = AnswererEvaluation.objects.filter(
        world=world, part="validation", order=answering_of(world).order
    )
    newest = rows.order_by("-made_at").select_related("split").first()
    tables = answerer_tables(world, [newest.split], newest.part) if newest else []
    return next(iter(tables), None)


def reliability_of(rows: Iterable[AnswererEvaluation]) -> Reliability | None:
    """Return how well the probabilities of stored answers keep their word; None where nothing was answered."""
    answers = [answer for row in rows for answer in row.answers if answer[0] is not None]
    if not answers:
        return None
    return reliability(
        [answer[0] for answer in answers], np.array([answer[1] for answer in answers])
    )


def reliability_chart(measured: Reliability) -> dict[str, Any]:
    """Return the reliability diagram: the share that is right by the probability that was said, with its 95 %
    interval; on the diagonal both are equal."""
    points = [
        [round(100 * number, 1) for number in (each.confidence, each.accuracy, *each.interval)]
        for each in measured.bins
    ]
    return {
        "kind": "points",
        "x": {"label": "said, %"},
        "y": {"label": "right", "unit": "%", "max": 100},
        "series": [
            {"name": "right", "points": points},
            {"name": "as said", "points": [[0, 0, 0, 0], [100, 100, 100, 100]]},
        ],
        "done": True,
    }


def as_row(row: AnswererEvaluation) -> dict[str, Any]:
    """Return a row as plain values: shares as fractions of 1, each with ``interval`` [low, high]; None where there is
    nothing that it could be a share of."""
    figures: dict[str, Any] = {}
    for name, whole in FIGURES.items():
        of = getattr(row, whole)
        figures[name] = getattr(row, name) / of if of else None
        figures[f"{name}_interval"] = row.intervals.get(name)
    return {
        "split": row.split.name,
        "part": row.part,
        "test_source": row.test_source,
        "order": row.order,
        "run": row.run_id,
        "count": row.count,
        **figures,
        "act_from": row.calibration["point"]["act"],
        "allowed_wrong": row.calibration["allowed_wrong"],
        "calibrated_on": row.calibration["examples"],
        "brier": row.brier,
        "brier_before": row.brier_before,
        "seconds": row.seconds,
    }


def bins_of(measured: Reliability) -> Iterator[dict[str, Any]]:
    """Yield the bins of a reliability diagram as plain values, fractions of 1."""
    for each in measured.bins:
        yield {
            "from": each.low,
            "to": each.high,
            "count": each.count,
            "said": each.confidence,
            "right": each.accuracy,
            "interval": list(each.interval),
        }
