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
