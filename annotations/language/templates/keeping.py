"""Keeps values that were worked out, up to a bound; those asked for longest ago go first."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Generic, TypeVar

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")


class Kept(Generic[Key, Value]):
    """Values by key. Threads may share one; two that miss at once both work the value out.

    Args:
        most: the sum of the weights of what is kept.
        weight: of a value, at least 0; a value heavier than ``most`` is never kept.
    """

    def __init__(self, most: int, weight: Callable[[Value], int] = lambda value: 1) -> None:
        self._most = most
        self._weight = weight
        self._values: OrderedDict[Key, Value] = OrderedDict()
        self._total = 0
        self._lock = Lock()

    def __contains__(self, key: Key) -> bool:
        return key in self._values

    def get(self, key: Key, make: Callable[[], Value]) -> Value:
        """Return the value of ``key``; ``make`` works it out where it is not here. Raises what it raises."""
        with self._lock:
            if key in self._values:
                self._values.move_to_end(key)
                return self._values[key]
        value = make()
        with self._lock:
            self._put(key, value)
        return value

    def _put(self, key: Key, value: Value) -> None:
        weight = self._weight(value)
        if weight > self._most or key in self._values:
            return
        self._values[key] = value
        self._total += weight
        while self._total > self._most:
            _, oldest = self._values.popitem(last=False)
            self._total -= self._weight(oldest)
