"""Every pair of compared runs: who is right where the other is wrong, and what that means."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from parser_service.analysis.comparing import Comparison
from parser_service.slices.addresses import Addresses
from parser_service.slices.choosing import LETTERS
from parser_service.slices.compared import Compared


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

    comparison: Comparison
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
    for each in compared.comparisons:
        if each.is_significant:
            words = ("better", "worse")[:: 1 if each.difference > 0 else -1]
            verdicts[each.first, each.second], verdicts[each.second, each.first] = words
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
