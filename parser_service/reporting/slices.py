"""The accuracy of runs on slices, as tables of a report."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from parser_service.analysis.slicing import SliceAccuracies, accuracy_by, bin_names
from parser_service.reporting.answers import Answers

MOST_SLICES = 25  # of one kind


@dataclass(frozen=True, slots=True)
class Accuracy:
    """Fractions of 1; the interval is Wilson's at 95 %."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Slice:
    """``accuracies`` has one entry a run."""

    name: str
    count: int
    accuracies: tuple[Accuracy, ...]


@dataclass(frozen=True, slots=True)
class SliceTable:
    """The slices of one kind; ``left_out`` counts those behind the largest ``MOST_SLICES``."""

    title: str
    slices: tuple[Slice, ...]
    left_out: int


def slice_tables(runs: Sequence[Answers]) -> Iterator[SliceTable]:
    """Yield a table for each kind of slice. The runs have answered the same examples, in the same order."""
    correct = np.array([run.is_right for run in runs])
    for title, labels in runs[0].slices():
        table = accuracy_by(correct, labels)
        order = _order(table)
        slices = tuple(_make_slice(table, place) for place in order[:MOST_SLICES])
        yield SliceTable(title, slices, max(0, len(order) - MOST_SLICES))


def _order(table: SliceAccuracies) -> list[int]:
    """Return the places of the slices: lengths and depths from small to large, others by their size."""
    bins = {name: number for number, name in enumerate(bin_names())}
    values = table.values

    def rank(place: int) -> tuple[float, int, str]:
        value = values[place]
        if isinstance(value, int):
            return value, 0, ""
        if value in bins:
            return bins[str(value)], 0, ""
        return float("inf"), -int(table.counts[place]), str(value)

    return sorted(range(len(values)), key=rank)


def _make_slice(table: SliceAccuracies, place: int) -> Slice:
    columns = (table.accuracies, table.low, table.high)
    accuracies = zip(*(each[:, place].tolist() for each in columns), strict=True)
    return Slice(
        str(table.values[place]),
        int(table.counts[place]),
        tuple(Accuracy(*each) for each in accuracies),
    )
