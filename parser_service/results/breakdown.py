"""Accuracy of the compared runs in each group and each saved slice, with the addresses of the answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from parser_service.analysis.encoded_labels import EncodedLabels
from parser_service.analysis.slicing import SliceAccuracies, accuracy_of_labels, accuracy_where
from parser_service.models import Slice
from parser_service.results.addresses import Addresses
from parser_service.results.compared import Compared, are_in_columns
from parser_service.results.groupings import GROUPINGS, Grouping
from parser_service.results.selecting import filters_of

MOST_ROWS = 40
MOST_ASKED = 50_000  # examples of a part, up to which a page also counts slices that take a query


@dataclass(frozen=True, slots=True)
class Accuracy:
    """The accuracy of one run in one slice, in percent; None in an empty one. ``is_best``: better than every other
    run, beyond chance."""

    correct: int
    count: int
    percent: float | None
    low: float
    high: float
    url: str
    is_best: bool = False


@dataclass(frozen=True, slots=True)
class SliceRow:
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
    rows: tuple[SliceRow, ...]
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
    rows = []
    for saved in Slice.objects.filter(world=compared.world):
        conditions = filters_of(compared.world, saved.query, of_run=compared.base).conditions(
            but=["part"]
        )
        chosen = {"slice": str(saved.pk)}
        is_quick = len(compared.examples.keys) <= MOST_ASKED
        if not is_quick and not are_in_columns(conditions, compared):
            rows.append(SliceRow(saved.name, None, addresses.compare(chosen)))
            continue
        mask = compared.mask(conditions)
        accuracies = accuracy_where(compared.correct, mask, compared.clusters)
        cells = _cells(accuracies, 0, addresses, chosen)
        count = int(accuracies.counts[0])
        rows.append(SliceRow(saved.name, count, addresses.compare(chosen), cells))
    return Breakdown("slices", "Saved slices", tuple(rows), is_of_base=True)


def _cells(
    accuracies: SliceAccuracies,
    place: int,
    addresses: Addresses,
    chosen: Mapping[str, str] | None,
) -> tuple[Accuracy, ...]:
    count, right = int(accuracies.counts[place]), accuracies.correct[:, place]
    return tuple(
        Accuracy(
            correct=correct,
            count=count,
            percent=100 * correct / count if count else None,
            low=100 * float(accuracies.low[run, place]) if count else 0.0,
            high=100 * float(accuracies.high[run, place]) if count else 0.0,
            url="" if chosen is None else addresses.of_run(run, chosen, only_wrong=correct < count),
            is_best=bool(accuracies.is_best[run, place]),
        )
        for run, correct in enumerate(right.tolist())
    )


def _by_group(compared: Compared, grouping: Grouping, addresses: Addresses) -> Breakdown:
    labels, n_groups = _most_frequent(grouping.labels(compared), grouping.is_ordered)
    accuracies = accuracy_of_labels(compared.correct, labels, compared.clusters)
    rows, titles = [], grouping.titles(compared)
    for place in range(len(labels.values)):
        label = str(accuracies.values[place])
        chosen = grouping.parameters(label)
        url = "" if chosen is None else addresses.of_base(chosen)
        cells = _cells(accuracies, place, addresses, chosen)
        rows.append(SliceRow(titles.get(label, label), int(accuracies.counts[place]), url, cells))
    return Breakdown(
        grouping.name,
        grouping.title,
        tuple(rows) if len(rows) > 1 else (),
        n_groups - len(labels.values),
        grouping.is_of_base,
    )


def _most_frequent(labels: EncodedLabels[str], is_ordered: bool) -> tuple[EncodedLabels[str], int]:
    """Return the groups to show, in their order or the frequent ones first, and how many groups there are.

    An example of another group has a code of none.
    """
    counts = labels.counts()
    there = np.flatnonzero(counts)
    if not is_ordered:
        there = there[np.argsort(-counts[there], kind="stable")]
    shown = there[:MOST_ROWS]
    codes = np.full(len(counts), len(shown))
    codes[shown] = np.arange(len(shown))
    return EncodedLabels(tuple(labels.values[place] for place in shown), codes[labels.codes]), len(
        there
    )
