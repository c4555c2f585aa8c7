"""The tables of a comparison: every pair of runs, and which head predicates a run takes for which."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from parser_service.analysis.comparing import RunComparison
from parser_service.results.addresses import Addresses
from parser_service.results.compared import Compared
from parser_service.results.run_choice import LETTERS

MOST_HEADS = 24
SHADES = (0.0, 0.02, 0.05, 0.1, 0.25)  # shares of a row from which a shade begins


@dataclass(frozen=True, slots=True)
class WinCell:
    """On ``count`` examples the run of the row is right and that of the column is wrong; None on the diagonal.
    ``verdict`` is ``better`` or ``worse`` where the difference of the two is significant."""

    count: int | None
    url: str = ""
    verdict: str = ""


@dataclass(frozen=True, slots=True)
class PairRow:
    """A comparison as a line of a table: letters of both runs, numbers in points of 100."""

    comparison: RunComparison
    letters: tuple[str, str]
    meaning: str

    @property
    def difference(self) -> float:
        return 100 * self.comparison.difference

    @property
    def low(self) -> float:
        return 100 * self.comparison.interval[0]

    @property
    def high(self) -> float:
        return 100 * self.comparison.interval[1]


def win_matrix(compared: Compared, addresses: Addresses) -> list[tuple[str, list[WinCell]]]:
    """Return a row for each run: its letter, and its wins against each run."""
    verdicts = {}
    for comparison in compared.comparisons:
        if comparison.is_significant:
            words = ("better", "worse")[:: 1 if comparison.difference > 0 else -1]
            pair = comparison.first, comparison.second
            verdicts[pair], verdicts[pair[::-1]] = words
    rows = []
    for first, wins in enumerate(compared.wins):
        cells = [
            WinCell(None)
            if first == second
            else WinCell(
                count,
                addresses.of_win(first, second) if count else "",
                verdicts.get((first, second), ""),
            )
            for second, count in enumerate(wins)
        ]
        rows.append((LETTERS[first], cells))
    return rows


def pair_rows(compared: Compared, names: Sequence[str]) -> list[PairRow]:
    """Return every pair in the order of the runs."""
    return [
        PairRow(each, (LETTERS[each.first], LETTERS[each.second]), each.meaning(names))
        for each in compared.comparisons
    ]


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
    order = {head: place for place, head in enumerate(rows)}
    columns = sorted(
        columns[:MOST_HEADS],
        key=lambda head: (head not in shown, order.get(head, len(rows) + head)),
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
