"""What can be wrong with a text, and where: the one shape in which every reader reports."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum


class Severity(StrEnum):
    """An ERROR refuses an import whole; a WARNING is stored beside what it is about."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, slots=True, order=True)
class Position:
    """A place in a source: ``source`` names a file, ``line`` and ``column`` count from 1."""

    source: str = ""
    line: int = 1
    column: int = 1

    def __str__(self) -> str:
        place = f"{self.line}:{self.column}"
        return f"{self.source}:{place}" if self.source else place

    def shifted(self, columns: int) -> Position:
        """The position ``columns`` characters further on the same line."""
        return Position(self.source, self.line, self.column + columns)


@dataclass(frozen=True, slots=True, order=True)
class Problem:
    """One finding: how grave, where, what, and what to do about it."""

    position: Position
    severity: Severity
    message: str
    hint: str = ""

    def __str__(self) -> str:
        hint = f" ({self.hint})" if self.hint else ""
        return f"{self.position}: {self.severity}: {self.message}{hint}"

    @property
    def is_error(self) -> bool:
        return self.severity is Severity.ERROR


@dataclass
class LanguageError(ValueError):
    """A text that cannot be read. Carries its position, a sentence and a hint."""

    message: str
    position: Position = field(default_factory=Position)
    hint: str = ""

    def __str__(self) -> str:
        return str(self.problem)

    @property
    def problem(self) -> Problem:
        return Problem(self.position, Severity.ERROR, self.message, self.hint)

    @property
    def source(self) -> str:
        return self.position.source

    @property
    def line(self) -> int:
        return self.position.line

    @property
    def column(self) -> int:
        return self.position.column


def error(position: Position, message: str, hint: str = "") -> Problem:
    """A problem that refuses an import."""
    return Problem(position, Severity.ERROR, message, hint)


def warning(position: Position, message: str, hint: str = "") -> Problem:
    """A problem that is stored and shown, and refuses nothing."""
    return Problem(position, Severity.WARNING, message, hint)
