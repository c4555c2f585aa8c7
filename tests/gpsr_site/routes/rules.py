"""What a rule of access says."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from django.db import transaction

PEOPLE = ("anonymous", "stranger", "annotator", "reviewer", "admin")
LOG_IN, NOWHERE, NO, YES, GONE_ON, WRONG, BAD = 302, 404, 403, 200, 302, 405, 400


@dataclass(frozen=True)
class Rule:
    """What happens to each of ``PEOPLE`` who asks for ``name`` with ``method``.

    ``stranger`` has every duty, in another world.
    """

    name: str
    anonymous: int
    stranger: int
    annotator: int
    reviewer: int
    admin: int
    method: str = "get"

    def __str__(self) -> str:
        return f"{self.method} {self.name}"


@contextmanager
def undone() -> Iterator[None]:
    """Undo what requests do, so that the next ones find the same rows."""
    with transaction.atomic():
        yield
        transaction.set_rollback(True)
