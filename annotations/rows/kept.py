"""Figures of very many rows, which a process keeps for a while instead of reading all rows for each page."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from time import monotonic
from typing import Any, NamedTuple, TypeVar

Value = TypeVar("Value")

MOST_READ = 10_000  # rows that are read for each page; figures of so few are always those of now
SHARE = 50  # for how many times the seconds of computing a figure is kept
MOST_SECONDS = 600.0
MOST_KEPT = 200  # figures of a process


class _Kept(NamedTuple):
    value: Any
    until: float


_kept: OrderedDict[Hashable, _Kept] = OrderedDict()


def kept(key: Hashable, compute: Callable[[], Value], rows: Callable[[Value], int]) -> Value:
    """Return ``compute()``, or what it returned a while ago.

    Args:
        key: tells the figure from all others; begins with the name of what computes it.
        rows: how many rows were read for a value; only one of over ``MOST_READ`` is kept.
    """
    now = monotonic()
    found = _kept.get(key)
    if found and now < found.until:
        value: Value = found.value
        return value
    value = compute()
    _kept.pop(key, None)
    if rows(value) > MOST_READ:
        _kept[key] = _Kept(value, now + min(SHARE * (monotonic() - now), MOST_SECONDS))
        while len(_kept) > MOST_KEPT:
            _kept.popitem(last=False)
    return value
