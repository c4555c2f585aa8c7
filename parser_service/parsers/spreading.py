"""Choosing a few of many, evenly and always alike."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Sequence
from typing import TypeVar

Item = TypeVar("Item")

_GOLDEN = 0.6180339887498949  # multiples of it, modulo 1, are even however many there are


def visiting_order(number: int) -> list[int]:
    """Return the numbers below ``number`` so that the first of them, however many, spread evenly."""
    return sorted(range(number), key=lambda at: at * _GOLDEN % 1)


def spread(
    items: Sequence[Item], most: int, group: Callable[[Item], Hashable] = lambda item: None
) -> list[Item]:
    """Return at most ``most`` of ``items``, in their order: as many of one group as of another, where
    there are enough, and spread evenly over each."""
    if len(items) <= most:
        return list(items)
    groups: defaultdict[Hashable, list[int]] = defaultdict(list)
    for at, item in enumerate(items):
        groups[group(item)].append(at)
    turns = [
        (turn, places[at])
        for places in groups.values()
        for turn, at in enumerate(visiting_order(len(places)))
    ]
    return [items[at] for _, at in sorted(sorted(turns)[:most], key=lambda each: each[1])]
