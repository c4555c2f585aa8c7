"""What is wrong with a text and where: the one form in which every reader reports problems."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from http import HTTPStatus
from importlib.util import find_spec
from typing import Any

EXCERPT_WIDTH = 78  # characters of a line that are shown around a problem


class Severity(StrEnum):
    """An ERROR stops the whole import; a WARNING is stored next to what it is about."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, slots=True, order=True)
class Position:
    """A place in a source: ``source`` names a file, ``line`` and ``column`` count from 1.

    A problem without a place gets the start of an unnamed text, which prints as nothing.
    """

    source: str = ""
    line: int = 1
    column: int = 1

    def __str__(self) -> str:
        if self == Position():
            return ""
        place = f"{self.line}:{self.column}"
        return f"{self.source}:{place}" if self.source else place

    def shifted(self, columns: int) -> Position:
        """Return the position ``columns`` characters further on the same line."""
        return Position(self.source, self.line, self.column + columns)

    def inside(self, outer: Position) -> Position:
        """Return this position, which counts from ``outer``, as a position of the source of ``outer``."""
        column = self.column + (outer.column - 1 if self.line == 1 else 0)
        return Position(outer.source, outer.line + self.line - 1, column)

    def excerpt(self, text: str) -> str:
        """Return this line of ``text`` (the whole source) with a caret below the column; empty past the end."""
        lines = text.split("\n")
        if self.line > len(lines):
            return ""
        line = lines[self.line - 1].replace("\t", " ")
        start = max(0, min(self.column - 1, len(line)) - EXCERPT_WIDTH // 2)
        shown = line[start : start + EXCERPT_WIDTH]
        return f"{shown}\n{' ' * (self.column - 1 - start)}^"


class Offsets:
    """Finds the position of a character of one text by its index."""

    def __init__(self, text: str, source: str = "") -> None:
        self._source = source
        self._line_starts = [0]
        self._line_starts += (at + 1 for at, character in enumerate(text) if character == "\n")

    def position(self, index: int) -> Position:
        """Return the position of the character at ``index``, counted from 0."""
        line = bisect_right(self._line_starts, index)
        return Position(self._source, line, index - self._line_starts[line - 1] + 1)

    def index(self, position: Position) -> int:
        """Return the index of the character at a line and column; one past the end is the last index."""
        line = min(max(position.line, 1), len(self._line_starts))
        return self._line_starts[line - 1] + max(position.column - 1, 0)


@dataclass(frozen=True, slots=True, order=True)
class TextEdit:
    """Characters ``start`` up to ``end`` (from 0) of the text called ``source`` become ``text``."""

    source: str
    start: int
    end: int
    text: str


@dataclass(frozen=True, slots=True, order=True)
class Repair:
    """One way to remove a problem: what it does, in words, and the edits that do it."""

    label: str
    edits: tuple[TextEdit, ...]

    def apply(self, source: str, text: str) -> str:
        """Return what the text called ``source`` becomes."""
        for edit in sorted(self.edits, reverse=True):
            if edit.source == source:
                text = text[: edit.start] + edit.text + text[edit.end :]
        return text


@dataclass(frozen=True, slots=True, order=True)
class Problem:
    """One problem: where it is, how serious, what is wrong and what to do about it.

    ``repairs`` are for an editor; ``task_category`` names the one whose productions the hint is about;
    ``undeclared`` names a predicate that could be declared. None of them plays a part in equality.
    """

    position: Position
    severity: Severity
    message: str
    hint: str = ""
    repairs: tuple[Repair, ...] = field(default=(), compare=False, repr=False)
    task_category: str = field(default="", compare=False, repr=False)
    undeclared: str = field(default="", compare=False, repr=False)

    def __str__(self) -> str:
        place = f"{self.position}: " if str(self.position) else ""
        hint = f" ({self.hint})" if self.hint else ""
        return f"{place}{self.severity}: {self.message}{hint}"

    @property
    def is_error(self) -> bool:
        return self.severity is Severity.ERROR


class Refusal(ValueError):
    """What a person asked for cannot be done. Pages, routes and commands say why, in its own words.

    ``message`` is a sentence for people. ``code`` names the reason for programs and tests, and stays
    when the sentence changes. ``status`` is the HTTP status that says it. ``problems`` are the things
    that are wrong, as the API lists them, each with its field or its place. A subclass is for callers
    who treat it apart from others.
    """

    code = "refused"
    status: int = HTTPStatus.BAD_REQUEST
    wait: int | None = None  # seconds until it is worth asking again (Retry-After)
    position: Position | None = None

    def __init__(
        self,
        message: str,
        code: str = "",
        status: int | None = None,
        problems: Iterable[Mapping[str, Any]] = (),
    ) -> None:
        super().__init__(message)
        self.message = message
        self.code = code or self.code
        self.status = self.status if status is None else status
        self.problems = tuple(problems)

    def __str__(self) -> str:
        return self.message


def require_package(name: str, extra: str) -> None:
    """Raise Refusal where the package ``name``, which the ``extra`` of this project brings, is not installed."""
    if find_spec(name) is None:
        raise Refusal(
            f"This needs the package {name}, which is not installed here. Install it beside the workbench: "
            f"pip install 'gpsr-workbench[{extra}]'.",
            "package_absent",
            HTTPStatus.NOT_IMPLEMENTED,
        )


@dataclass
class LanguageError(Refusal):
    """A text cannot be read. The error has a position, a sentence and a hint."""

    code = "unreadable"
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


def error_at(position: Position, message: str, hint: str = "") -> Problem:
    """Return a problem that stops an import."""
    return Problem(position, Severity.ERROR, message, hint)


def warning_at(position: Position, message: str, hint: str = "") -> Problem:
    """Return a problem that is stored and shown but stops nothing."""
    return Problem(position, Severity.WARNING, message, hint)
