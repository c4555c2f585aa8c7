"""The accuracy tables as rows of a plain table."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from typing import Any

from parser_service.results.accuracy import Column, Row, Table
from parser_service.results.cells import Cell

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
# Over all seeds of a cell.
SEED_FIELDS = ("mean", "spread", "n_seeds")
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
)


def rows_of(tables: Iterable[Table]) -> Iterator[tuple[Any, ...]]:
    """Yield one row per scored cell; accuracies are fractions of 1.

    The figures of the newest run come first, then mean and spread (the sample standard deviation,
    empty for one run) over all seeds.
    """
    for table in tables:
        for row, cells in table.filled:
            for column, cell in cells:
                if cell and cell.score:
                    yield (*_about(table, row, column), *_figures(cell))


def _about(table: Table, row: Row, column: Column) -> tuple[Any, ...]:
    configuration = json.dumps(dict(row.changes))
    split = column.split
    return (row.parser, configuration, table.protocol, *column.setting, split.name, split.criterion)


def _figures(cell: Cell) -> tuple[Any, ...]:
    newest = tuple(getattr(cell.score, name) for name in SCORE_FIELDS)
    return newest + tuple(getattr(cell.over_seeds, name) for name in SEED_FIELDS)
