"""A cache of bounded size that several threads may share."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Generic, TypeVar

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")


class BoundedCache(Generic[Key, Value]):
    """Values by key; the least recently used go first. Two threads that miss at once both make the value.

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
        """Return the value of ``key``, made by ``make`` if it is missing. Raises what ``make`` raises."""
        with self._lock:
            if key in self._values:
                self._values.move_to_end(key)
                return self._values[key]
        value = make()
        with self._lock:
            weight = self._weight(value)
            if weight <= self._most and key not in self._values:
                self._values[key] = value
                self._total += weight
                while self._total > self._most:
                    _, oldest = self._values.popitem(last=False)
                    self._total -= self._weight(oldest)
        return value
