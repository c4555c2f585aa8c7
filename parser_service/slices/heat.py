"""The confusion of head predicates as a table whose cells are shaded by their share of a row."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass

import numpy as np

from parser_service.slices.addresses import Addresses
from parser_service.slices.compared import Compared

MOST_HEADS = 24
SHADES = (0.0, 0.02, 0.05, 0.1, 0.25)  # shares of a row from which a shade begins


@dataclass(frozen=True, slots=True)
class HeatCell:
    """``count`` answers, ``share`` percent of the row; ``shade`` from 1 to 5, 0 for the diagonal and for none."""

    count: int
    share: float
    shade: int
    url: str


@dataclass(frozen=True, slots=True)
class HeatRow:
    """The labels with one head predicate: ``count`` of them, and their answers by head predicate."""

    head: str
    count: int
    cells: tuple[HeatCell, ...]


@dataclass(frozen=True, slots=True)
class HeatTable:
    """``n_more`` rare head predicates are left out."""

    columns: tuple[str, ...]
    rows: tuple[HeatRow, ...]
    n_errors: int
    n_more: int


def confusion_table(compared: Compared, run: int, addresses: Addresses) -> HeatTable:
    """Return which head predicates a run takes for which, on all that is compared."""
    confusion = compared.confusion(run)
    counts = confusion.counts
    labels, answers = counts.sum(axis=1), counts.sum(axis=0)
    rows = [place for place in np.argsort(-labels, kind="stable").tolist() if labels[place]]
    columns = [place for place in range(len(confusion.heads)) if answers[place]]
    shown = set(rows[:MOST_HEADS])
    # An answer's head that no shown label has stays as long as there is room for it.
    columns = sorted(columns, key=lambda place: (place not in shown, -int(answers[place])))
    columns = sorted(
        columns[:MOST_HEADS], key=lambda place: (place not in shown, _place(place, rows))
    )
    table = []
    for row in rows[:MOST_HEADS]:
        cells = []
        for column in columns:
            count, share = int(counts[row, column]), float(counts[row, column] / labels[row])
            label, answer = confusion.heads[row], confusion.heads[column]
            cells.append(
                HeatCell(
                    count=count,
                    share=100 * share,
                    shade=bisect_right(SHADES, share) if count and row != column else 0,
                    url=addresses.of_confusion(run, label, answer) if count else "",
                )
            )
        table.append(HeatRow(confusion.heads[row], int(labels[row]), tuple(cells)))
    return HeatTable(
        columns=tuple(confusion.heads[place] for place in columns),
        rows=tuple(table),
        n_errors=int(counts.sum() - np.trace(counts)),
        n_more=max(0, len(rows) - MOST_HEADS),
    )


def _place(head: int, rows: list[int]) -> int:
    return rows.index(head) if head in rows else len(rows) + head
