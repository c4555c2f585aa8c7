"""Figures of very many rows, which a process keeps for a while instead of reading all rows for each page.

A figure is kept for long beside the time of computing it, so that computing takes a small share of a process.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from time import monotonic
from typing import Any, Generic, TypeVar

MOST_READ = 10_000  # rows that are read for each page; figures of so few are always those of now
# For how many times the seconds of computing it a figure is kept; the second where most of the rows may have changed.
SHARE, SHARE_AFTER_CHANGE = 50, 5
MOST_SECONDS = 600.0
MOST_KEPT = 200  # figures of a process

Value = TypeVar("Value")


@dataclass(frozen=True, slots=True)
class Kept(Generic[Value]):
    """A value that took some ``seconds``, computed at that second of ``monotonic``. ``stamp`` is what had last changed
    most of its rows."""

    value: Value
    computed_at: float
    seconds: float
    stamp: Hashable = None

    def is_due(self, stamp: Hashable = None) -> bool:
        """Whether it is to be computed anew."""
        share = SHARE if stamp == self.stamp else SHARE_AFTER_CHANGE
        return self.age >= min(share * self.seconds, MOST_SECONDS)

    @property
    def age(self) -> float:
        """The seconds since it was computed."""
        return monotonic() - self.computed_at


_kept: OrderedDict[Hashable, Kept[Any]] = OrderedDict()


def keep(key: Hashable, compute: Callable[[], Value], rows: Callable[[Value], int]) -> Kept[Value]:
    """Return ``compute()``, or what it returned a while ago.

    Args:
        key: tells the figure from all others; begins with the name of what computes it.
        rows: how many rows were read for a value; only one of over ``MOST_READ`` is kept.
    """
    found: Kept[Value] | None = _kept.get(key)
    if found and not found.is_due():
        return found
    began = monotonic()
    value = compute()
    made = Kept(value, began, monotonic() - began)
    _kept.pop(key, None)
    if rows(value) > MOST_READ:
        _kept[key] = made
        while len(_kept) > MOST_KEPT:
            _kept.popitem(last=False)
    return made


def kept(key: Hashable, compute: Callable[[], Value], rows: Callable[[Value], int]) -> Value:
    """Return the value of ``keep``."""
    return keep(key, compute, rows).value
