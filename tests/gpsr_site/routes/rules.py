"""What a rule of access says."""

from __future__ import annotations

from dataclasses import dataclass

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
