"""Methods whose answers are remembered."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from typing import Any, Concatenate, Generic, ParamSpec, TypeVar, cast

P = ParamSpec("P")
R = TypeVar("R")


class RememberingMethod(Generic[P, R]):
    """A method with a cache for each object, which ends with it."""

    def __init__(self, method: Callable[Concatenate[Any, P], R], most: int | None) -> None:
        self._method = method
        self._most = most

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, instance: Any, owner: type | None = None) -> Callable[P, R]:
        """Return the method of ``instance`` with a cache; it takes the place of this one there."""
        cached = lru_cache(maxsize=self._most)(partial(self._method, instance))
        instance.__dict__[self._name] = cached
        return cast("Callable[P, R]", cached)


def remembered(
    most: int | None = None,
) -> Callable[[Callable[Concatenate[Any, P], R]], RememberingMethod[P, R]]:
    """Decorate a method so that each object remembers its last ``most`` answers, or all of them.

    Arguments are hashable, and handed in by place. ``functools.lru_cache`` on a method would share one
    cache among all objects, and keep them alive.
    """
    return lambda method: RememberingMethod(method, most)
