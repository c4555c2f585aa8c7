"""The accuracy tables as rows of a plain table and as JSON: what the page shows, one figure a row."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from typing import Any

from annotations.models import World
from parser_service.models.evaluations import KNOWN_FORMS, UNSEEN
from parser_service.results.answerer_rows import answerer_tables, as_row
from parser_service.results.measures import Measure
from parser_service.results.result_choices import ResultsChoices
from parser_service.results.seed_figures import AccuracyFigure
from parser_service.results.table_parts import (
    AccuracyTable,
    may_know_corpora,
)

# Of the newest run of a cell.
SCORE_FIELDS = (
    "part",
    "run_id",
    "count",
    "correct",
    "accuracy",
    "interval_low",
    "interval_high",
    "equivalent",
    "well_formed",
)
# Exact match over all seeds of a cell.
SEED_FIELDS = ("mean", "spread", "n_seeds")
# The figure that the page shows, in percent; by form a harmonic mean.
FIGURE_FIELDS = ("measure", "percent", "plus_minus", "low", "high", "is_best", "published")
# The model that answered, as its server reports it, and whether it may have read a public corpus.
MODEL_FIELDS = ("answered_by", "may_know_corpora")
# By form, what it is the mean of, each with the ends of its interval.
PART_FIELDS = ("unseen", "unseen_low", "unseen_high", "known", "known_low", "known_high")
# Of the newest run too; empty where plans were not compared.
PLAN_FIELDS = ("same_plan",)
# The columns, in this order in every release.
HEADER = (
    "parser",
    "configuration",
    "protocol",
    "train_sources",
    "test_source",
    "split",
    "criterion",
    *SCORE_FIELDS,
    *SEED_FIELDS,
    *FIGURE_FIELDS,
    *MODEL_FIELDS,
    *PART_FIELDS,
    *PLAN_FIELDS,
)


def rows_of(tables: Iterable[AccuracyTable]) -> Iterator[tuple[Any, ...]]:
    """Yield one row per figure of a scored cell; accuracies are fractions of 1.

    What the newest run scored comes first, then mean and spread of exact match (the sample standard
    deviation, empty for one run) over all seeds, then the figure as the page shows it, in percent, with
    how far its 95 % interval reaches (``plus_minus``), then ``MODEL_FIELDS``, by form the figures on
    unseen and on known forms (``PART_FIELDS``), and ``PLAN_FIELDS``. A figure that is not known has its measure alone.
    """
    for table in tables:
        for row, cells in table.filled:
            for column, cell in cells:
                if cell and cell.score:
                    about = (
                        row.parser,
                        json.dumps(dict(row.changes)),
                        table.protocol,
                        *column.setting,
                        column.split.name,
                        column.split.criterion,
                        *(getattr(cell.score, name) for name in SCORE_FIELDS),
                        *(getattr(cell.over_seeds, name) for name in SEED_FIELDS),
                    )
                    model = (cell.answered_by, may_know_corpora(row.parser))
                    plans = [getattr(cell.score, name) for name in PLAN_FIELDS]
                    for measure, figure in zip(table.measures, cell.figures, strict=True):
                        yield (*about, *_figure_and_model(measure, figure, model), *plans)


def as_json(
    world: World, choices: ResultsChoices, tables: Iterable[AccuracyTable]
) -> dict[str, Any]:
    """Return the choices of the page, the rows of ``rows_of``, each with its names, and what a robot gets from the
    answerer of the world by source."""
    measured = answerer_tables(world, choices.splits, choices.part)
    return {
        "world": world.name,
        "part": choices.part,
        "splits": [split.name for split in choices.splits],
        "measures": list(choices.measures),
        "published": choices.published,
        "figures": [dict(zip(HEADER, row, strict=True)) for row in rows_of(tables)],
        "answerer": [as_row(each.row) for table in measured for each in table.rows],
    }


def _figure_and_model(
    measure: Measure, figure: AccuracyFigure | None, model: tuple[str, bool]
) -> Iterator[str | float | bool | None]:
    """Yield the values of ``FIGURE_FIELDS``, ``MODEL_FIELDS`` and ``PART_FIELDS``.

    The parts are the figures on unseen and on known forms with their intervals; None each where there is none. On
    unseen forms alone it is the figure itself.
    """
    if figure is None:
        nothing = [None] * (len(FIGURE_FIELDS) - 1)
        yield from (measure, *nothing, *model, *[None] * len(PART_FIELDS))
        return
    yield from (measure, figure.percent, figure.reach, figure.low, figure.high)
    yield from (figure.is_best, figure.published, *model)
    parts = {part.label: (part.percent, part.low, part.high) for part in figure.parts}
    if figure.alone:
        parts[UNSEEN] = (figure.percent, figure.low, figure.high)
    for label in (UNSEEN, KNOWN_FORMS):
        yield from parts.get(label, (None, None, None))
