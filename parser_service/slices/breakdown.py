"""Accuracy of the compared runs in each group and each saved slice, with the addresses of the answers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from parser_service.analysis.slicing import SliceAccuracies, accuracy_of_labels, accuracy_where
from parser_service.models import Slice
from parser_service.slices.addresses import Addresses
from parser_service.slices.compared import Compared, are_in_columns
from parser_service.slices.groupings import GROUPINGS, Grouping
from parser_service.slices.selecting import filters_of

MOST_ROWS = 40
MOST_ASKED = 50_000  # examples of a part, up to which a page also counts slices that take a query


@dataclass(frozen=True, slots=True)
class Accuracy:
    """The accuracy of one run in one slice, in percent; None in an empty one."""

    correct: int
    count: int
    percent: float | None
    low: float
    high: float
    url: str
    is_best: bool = False


@dataclass(frozen=True, slots=True)
class Row:
    """A slice: ``count`` examples, and the accuracy of each run. ``count`` is None where it was not counted."""

    title: str
    count: int | None
    url: str
    cells: tuple[Accuracy, ...] = ()


@dataclass(frozen=True, slots=True)
class Breakdown:
    """The slices of one kind. ``n_more`` rare ones are not among its rows."""

    name: str
    title: str
    rows: tuple[Row, ...]
    n_more: int = 0
    is_of_base: bool = False


def accuracies_of(compared: Compared, addresses: Addresses) -> tuple[Accuracy, ...]:
    """Return the accuracy of each run on all that is compared."""
    return _cells(compared.accuracies, 0, addresses, {})


def break_down(compared: Compared, addresses: Addresses) -> list[Breakdown]:
    """Return the accuracies by group, for each grouping that tells the examples apart."""
    tables = (_by_group(compared, grouping, addresses) for grouping in GROUPINGS)
    return [table for table in tables if table.rows]


def break_down_by_slices(compared: Compared, addresses: Addresses) -> Breakdown:
    """Return the accuracies in the saved slices of the world."""
    rows = tuple(_slice_rows(compared, addresses))
    return Breakdown("slices", "Saved slices", rows, is_of_base=True)


def _by_group(compared: Compared, grouping: Grouping, addresses: Addresses) -> Breakdown:
    accuracies = accuracy_of_labels(compared.correct, grouping.labels(compared))
    there = np.flatnonzero(accuracies.counts)
    if not grouping.is_ordered:
        there = there[np.argsort(-accuracies.counts[there], kind="stable")]
    rows, titles = [], grouping.titles(compared)
    for place in there[:MOST_ROWS].tolist():
        label = str(accuracies.values[place])
        chosen = grouping.parameters(label)
        url = "" if chosen is None else addresses.of_base(chosen)
        cells = _cells(accuracies, place, addresses, chosen)
        rows.append(Row(titles.get(label, label), int(accuracies.counts[place]), url, cells))
    return Breakdown(
        grouping.name,
        grouping.title,
        tuple(rows) if len(rows) > 1 else (),
        max(0, len(there) - MOST_ROWS),
        grouping.is_of_base,
    )


def _slice_rows(compared: Compared, addresses: Addresses) -> Iterator[Row]:
    for saved in Slice.objects.filter(world=compared.world):
        conditions = filters_of(compared.world, saved.query, of_run=compared.base).conditions(
            but=["part"]
        )
        chosen = {"slice": str(saved.pk)}
        is_quick = len(compared.examples.keys) <= MOST_ASKED
        if not is_quick and not are_in_columns(conditions, compared):
            yield Row(saved.name, None, addresses.compare(chosen))
            continue
        accuracies = accuracy_where(compared.correct, compared.mask(conditions))
        cells = _cells(accuracies, 0, addresses, chosen)
        yield Row(saved.name, int(accuracies.counts[0]), addresses.compare(chosen), cells)


def _cells(
    accuracies: SliceAccuracies,
    place: int,
    addresses: Addresses,
    chosen: Mapping[str, str] | None,
) -> tuple[Accuracy, ...]:
    count, right = int(accuracies.counts[place]), accuracies.correct[:, place]
    best = int(right.max(initial=0))
    is_telling = len(right) > 1 and int(right.min(initial=0)) < best
    return tuple(
        Accuracy(
            correct=correct,
            count=count,
            percent=100 * correct / count if count else None,
            low=100 * float(accuracies.low[run, place]) if count else 0.0,
            high=100 * float(accuracies.high[run, place]) if count else 0.0,
            url=""
            if chosen is None
            else addresses.of_run(run, chosen, "wrong" if correct < count else ""),
            is_best=is_telling and correct == best,
        )
        for run, correct in enumerate(right.tolist())
    )
