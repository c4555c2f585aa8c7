"""The errors of the client."""

from __future__ import annotations

from typing import Any


class WorkbenchError(Exception):
    """The workbench did not do what was asked; a sentence says why, and a ``code`` where the workbench answered."""

    def __init__(self, detail: str, code: str = "") -> None:
        super().__init__(detail)
        self.code = code


class Away(WorkbenchError):
    """Nobody answers, or the parse server is away. Asking again later may help."""


class Refused(WorkbenchError):
    """The request was refused: the ``code`` of the reason, an HTTP ``status``, and ``problems`` with their fields or
    places."""

    def __init__(
        self, status: int, detail: str, problems: list[dict[str, Any]], code: str = ""
    ) -> None:
        super().__init__(detail, code)
        self.status = status
        self.problems = problems
