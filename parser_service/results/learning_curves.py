"""Accuracy by the number of training pairs: one curve for each parser of a column of the accuracy table."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from statistics import fmean
from typing import Any

from django.urls import reverse
from django.utils.http import urlencode

from annotations.language.corpus import KNOWN
from annotations.models import Split, World
from parser_service.models import Evaluation, TrainingRun
from parser_service.parsers.conditions import Setting, settings_of
from parser_service.parsers.registry import title_of
from parser_service.results.accuracy_cells import Cell
from parser_service.results.accuracy_tables import TableMaker, by_part, rank_of
from parser_service.results.measures import Measure
from parser_service.results.table_parts import Changes, TableColumn, marked
from parser_service.runs.learning_curve import MOST_SEEDS, SHARES, points_of

_SEEDS = (1, 3, MOST_SEEDS)  # what is offered


@dataclass(frozen=True, slots=True)
class CurvePoint:
    """The runs on one share of the training pairs. ``pairs`` is their number, None before one is scored."""

    share: float
    pairs: int | None
    cell: Cell | None


@dataclass(frozen=True, slots=True)
class LearningCurve:
    """A parser with one configuration; ``points`` by share, the ``SHARES`` at least. Missing runs are requested
    like ``run``; ``asked`` has share and seed of those that are there."""

    parser: str
    changes: Changes
    points: tuple[CurvePoint, ...]
    run: TrainingRun
    asked: frozenset[tuple[float, int]]

    @property
    def title(self) -> str:
        return title_of(self.parser)

    @property
    def label(self) -> str:
        """The title, with what tells it apart from other configurations of the parser."""
        changes = ", ".join(f"{name} {value}" for name, value in self.changes)
        return f"{self.title} ({changes})" if changes else self.title

    @property
    def offers(self) -> list[tuple[int, int]]:
        """Numbers of seeds with how many runs they need more, those that need any."""
        numbers = ((n, len(set(points_of(self.run, n)) - self.asked)) for n in _SEEDS)
        return [(n_seeds, missing) for n_seeds, missing in numbers if missing]

    @property
    def is_active(self) -> bool:
        return any(point.cell and point.cell.active for point in self.points)


@dataclass(frozen=True, slots=True)
class LearningCurves:
    """All curves of one column under one protocol, by one measure, on one part."""

    column: TableColumn
    protocol: str
    part: str
    measure: Measure
    curves: tuple[LearningCurve, ...] = field(default=())

    @property
    def shares(self) -> list[float]:
        return sorted({point.share for curve in self.curves for point in curve.points})

    @property
    def filled(self) -> list[tuple[LearningCurve, list[CurvePoint]]]:
        """Each curve with a point for each of ``shares``, an empty one where it has none."""
        return [
            (curve, [points.get(share, CurvePoint(share, None, None)) for share in self.shares])
            for curve in self.curves
            for points in ({point.share: point for point in curve.points},)
        ]

    @property
    def is_active(self) -> bool:
        return any(curve.is_active for curve in self.curves)

    @property
    def chart(self) -> dict[str, Any]:
        """The data of the chart: for each curve points [pairs, percent, low, high]."""
        return {
            "kind": "points",
            "x": {"label": "training pairs"},
            "y": {"label": self.measure.in_words, "max": 100, "unit": "%"},
            "series": [
                {
                    "name": marked(curve.label, curve.parser),
                    "points": [
                        [point.pairs, figure.percent, figure.low, figure.high]
                        for point in curve.points
                        if point.pairs is not None and point.cell
                        if (figure := point.cell.first) is not None
                    ],
                }
                for curve in self.curves
            ],
            "done": not self.is_active,
        }


def learning_curves(
    world: World, split: Split, setting: Setting, protocol: str, part: str, measure: Measure
) -> LearningCurves:
    """Return the curves of every parser that was trained for ``setting`` on ``split``. Two queries.

    A curve has runs of one version of its parser, the newest.
    """
    column = TableColumn(*setting, split, split.name)
    runs = world.runs.filter(
        split=split, train_sources=setting.train_sources, protocol=protocol
    ).scored_or_active()
    newest_first = list(runs.order_by("-id"))
    scores = Evaluation.objects.filter(
        run__in=newest_first, part__in=[part, KNOWN], test_source=setting.test_source
    )
    maker = TableMaker(
        world=world,
        part=part,
        columns=(column,),
        scores=by_part(scores, part),
        known=by_part(scores, KNOWN),
        published={},
        measures=(measure,),
    )
    grouped: dict[tuple[str, Changes], list[TrainingRun]] = defaultdict(list)
    for run in newest_first:
        grouped[run.parser, run.changed_hyperparameters()].append(run)
    ranked = sorted(grouped.items(), key=lambda item: rank_of(*item[0]))
    curves = (_curve(maker, parser, changes, mine) for (parser, changes), mine in ranked)
    return LearningCurves(column, protocol, part, measure, tuple(curves))


def curves_url(world: World, run: TrainingRun, test_source: str = "", part: str = "") -> str:
    """Return the address of the curves that ``run`` belongs to, by default as tested on what it is first
    tested on in the accuracy table."""
    setting = next(
        setting
        for setting in settings_of(run.train_sources)
        if test_source in ("", setting.test_source)
    )
    chosen = {"split": run.split.name, "setting": str(setting), "protocol": run.protocol}
    if part:
        chosen["part"] = part
    return f"{reverse('learning_curves', kwargs={'world': world.name})}?{urlencode(chosen)}"


def _curve(
    maker: TableMaker, parser: str, changes: Changes, runs: list[TrainingRun]
) -> LearningCurve:
    version = max(run.parser_version for run in runs)
    alike = [run for run in runs if run.parser_version == version]
    shares = sorted({*SHARES, *(run.train_share for run in alike)})
    points = []
    for share in shares:
        on_share = [run for run in alike if run.train_share == share]
        cell = maker.cell(parser, maker.columns[0], on_share)
        counted = {score.run_id for score in cell.scores} if cell else set()
        pairs = [run.train_pairs for run in on_share if run.pk in counted]
        known = [count for count in pairs if count is not None]
        points.append(CurvePoint(share, round(fmean(known)) if known else None, cell))
    first = min(alike, key=lambda run: (run.train_share < 1, run.seed))
    asked = frozenset((run.train_share, run.seed) for run in alike)
    return LearningCurve(parser, changes, tuple(points), first, asked)
