"""How a verb tells of its progress, hears that it is to stop, and writes what it made."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from typing import Any, Protocol

from django.db import transaction


class Progress(Protocol):
    """Whoever watches a verb at work."""

    def report(self, fraction: float, message: str) -> None:
        """Take note that ``fraction`` (0–1) is done and ``message`` is what happens now."""

    def check(self) -> None:
        """Raise an exception when the verb is to stop; do nothing otherwise. Costs next to nothing."""

    def writing(self) -> AbstractContextManager[Any]:
        """Return a transaction; entering it raises an exception where the verb is to stop."""

    def conclude(self, report: Mapping[str, Any]) -> None:
        """Take note of what came of it, in the transaction that writes it."""


class Unwatched:
    """Nobody watches, and nobody stops the verb."""

    def report(self, fraction: float, message: str) -> None:
        pass

    def check(self) -> None:
        pass

    def writing(self) -> AbstractContextManager[Any]:
        return transaction.atomic()

    def conclude(self, report: Mapping[str, Any]) -> None:
        pass


UNWATCHED = Unwatched()


class PartOfProgress:
    """The progress of a verb that another one calls, between two fractions of the other's. What comes of the
    part concludes nothing."""

    def __init__(self, whole: Progress, start: float, end: float) -> None:
        self._whole = whole
        self._start = start
        self._end = end

    def report(self, fraction: float, message: str) -> None:
        self._whole.report(self._start + fraction * (self._end - self._start), message)

    def check(self) -> None:
        self._whole.check()

    def writing(self) -> AbstractContextManager[Any]:
        return self._whole.writing()

    def conclude(self, report: Mapping[str, Any]) -> None:
        pass
