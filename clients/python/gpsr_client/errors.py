"""The errors of the client."""

from __future__ import annotations

from typing import Any


class WorkbenchError(Exception):
    """The workbench did not do what was asked; a sentence says why."""


class Away(WorkbenchError):
    """Nobody answers, or the parse server is away. Asking again later may help."""


class Refused(WorkbenchError):
    """The request was refused: an HTTP ``status``, and ``problems`` with their fields or places."""

    def __init__(self, status: int, detail: str, problems: list[dict[str, Any]]) -> None:
        super().__init__(detail)
        self.status = status
        self.problems = problems
