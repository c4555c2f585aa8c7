"""The accuracy tables as rows of a plain table and as JSON: what the page shows, one figure a row."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from typing import Any

from annotations.models import World
from parser_service.results.cells import Cell, Figure
from parser_service.results.choices import ResultsChoices
from parser_service.results.tables import Column, Row, Table

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
# The figure that the page shows, in percent.
FIGURE_FIELDS = ("measure", "percent", "plus_minus", "low", "high", "is_best", "published")
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
)


def rows_of(tables: Iterable[Table]) -> Iterator[tuple[Any, ...]]:
    """Yield one row per figure of a scored cell; accuracies are fractions of 1.

    What the newest run scored comes first, then mean and spread of exact match (the sample standard
    deviation, empty for one run) over all seeds, then the figure as the page shows it, in percent.
    """
    for table in tables:
        for row, cells in table.filled:
            for column, cell in cells:
                if cell and cell.score:
                    about = (*_about(table, row, column), *_scores(cell))
                    yield from ((*about, *_shown(figure)) for figure in cell.figures)


def as_json(world: World, choices: ResultsChoices, tables: Iterable[Table]) -> dict[str, Any]:
    """Return the choices of the page and the rows of ``rows_of``, each with its names."""
    return {
        "world": world.name,
        "part": choices.part,
        "splits": [split.name for split in choices.splits],
        "measures": list(choices.measures),
        "published": choices.published,
        "figures": [dict(zip(HEADER, row, strict=True)) for row in rows_of(tables)],
    }


def _about(table: Table, row: Row, column: Column) -> tuple[Any, ...]:
    configuration = json.dumps(dict(row.changes))
    split = column.split
    return (row.parser, configuration, table.protocol, *column.setting, split.name, split.criterion)


def _scores(cell: Cell) -> tuple[Any, ...]:
    newest = tuple(getattr(cell.score, name) for name in SCORE_FIELDS)
    return newest + tuple(getattr(cell.over_seeds, name) for name in SEED_FIELDS)


def _shown(figure: Figure) -> tuple[Any, ...]:
    return (
        figure.measure,
        figure.percent,
        figure.spread,
        figure.low,
        figure.high,
        figure.is_best,
        figure.published,
    )
