"""Read the results of a paraphrasing task on a crowd market: who rewrote which command how.

docs/reference/formats.md, Crowd tables, describes them.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from annotations.language.forms import canonical_text, read_form
from annotations.language.texts import (
    LanguageError,
    Position,
    Problem,
    error_at,
    normalise_line,
    warning_at,
)

MOST_ASSIGNMENTS = 20_000  # rows of a table
MOST_ANSWERS = 300_000  # of a table
MOST_COLUMNS = 2_000
MOST_OF_FORMS = 5_000_000  # characters of different forms: some 20 s of reading
# Answers of one assignment are compared with each other.
_MOST_NUMBERED = {"answer.utterance": 100, "answer.custom": 20}
MOST_SECONDS = 24 * 3600  # who worked for longer was away
# What the column with somebody's id is called here, and what links to a campaign call it.
_WORKERS = {
    "workerid": "workerId",
    **dict.fromkeys(("prolific_pid", "participant id", "participant_id"), "PROLIFIC_PID"),
}
# What the columns with the market's id of what somebody did, and with its state, are called.
_ASSIGNMENTS = ("assignmentid", "submission id", "submission_id", "session_id")
_STATES = ("assignmentstatus", "status")
_REJECTED = {"rejected"}
# Of work that somebody gave back, or that was never handed in; without blanks and signs.
_UNFINISHED = {
    *("returned", "timedout", "abandoned", "expired", "screenedout", "cancelled", "canceled"),
    *("active", "reserved", "incomplete", "inprogress", "started", "partial", "noconsent"),
}
_NUMBERED = re.compile(
    r"(?P<name>input\.command|input\.parse_ground|input\.parse|answer\.utterance|answer\.custom)"
    r"(?P<number>\d{1,3})"
)
_LINE = re.compile(r"[^\n]*\n|[^\n]+")
_DELIMITERS = ",;\t"
_DECLARED = re.compile(r"\"?sep=([,;\t])\"?\n", re.IGNORECASE)  # Excel's first line
# The apostrophe with which exports keep spreadsheets from reading a formula.
_FORMULA_GUARD = re.compile(r"\A'(?=[=+@-])")


@dataclass(frozen=True, slots=True)
class CrowdRewrite:
    """An answer to a prompt.

    ``column`` counts the cells of the row from 1. ``form`` has class tokens, ``grounded_form`` entities; both are
    canonical, and empty where the table has none.
    """

    column: int
    command: str
    form: str
    grounded_form: str
    text: str


@dataclass(frozen=True, slots=True)
class Assignment:
    """What one person did once.

    ``market`` is the name under which links have the id ``worker``. ``key`` is the market's id of the assignment, empty
    where the table has none. Nobody stores the two. ``seconds`` are those of all answers together, None where they
    are not known.
    """

    line: int
    market: str
    worker: str = field(repr=False)
    key: str = field(default="", repr=False)
    seconds: float | None = None
    rewrites: tuple[CrowdRewrite, ...] = ()
    free_commands: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class CrowdTable:
    """A table of results. ``rejected``, ``unfinished`` and empty assignments are only counted, and so are ``comments``.

    The column of a problem counts the cells of its row from 1.
    """

    assignments: tuple[Assignment, ...] = ()
    rejected: int = 0
    unfinished: int = 0
    empty: int = 0
    comments: int = 0
    problems: tuple[Problem, ...] = ()


def read_crowd_results(
    text: str, source: str, longest: int, worker_parameter: str = ""
) -> CrowdTable:
    """Read a table with ``WorkerId``, ``Input.command1``, ``Answer.utterance1`` and so on.

    Its cells are separated by commas, semicolons or tabs, or as Excel's line ``sep=;`` says. Rows whose
    ``AssignmentStatus`` is Rejected, or says that they were given back or timed out, blank rows and empty answers are
    left out. Errors are returned, not raised.

    Args:
        text: with ``\\n`` for every line end.
        longest: characters of an answer; a longer one is left out with a warning.
        worker_parameter: what links to the campaign call somebody's id; a column of that name has it, too.
    """
    declared = _DECLARED.match(text)
    if declared:
        text = text[declared.end() - 1 :]  # the line stays, empty, so that lines keep their numbers
    head, _, _ = text.lstrip().partition("\n")
    delimiter = declared[1] if declared else max(_DELIMITERS, key=head.count)
    lines = (match[0] for match in _LINE.finditer(text))
    rows = csv.reader(lines, delimiter=delimiter, strict=True)
    reader = _Reader(source, longest, worker_parameter)
    try:
        reader.read_head(next(filter(None, rows), []), rows.line_num)
        begun = rows.line_num + 1
        for cells in rows:
            line, begun = begun, rows.line_num + 1
            if any(cell.strip() for cell in cells):
                reader.read_row(cells, line)
    except LanguageError as error:
        reader.problems.append(error.problem)
    except csv.Error:
        place = Position(source, max(rows.line_num, 1))
        sentence = "the table breaks off inside a cell, or has one too long"
        reader.problems.append(error_at(place, sentence, "close its quotation mark"))
    return reader.table()


class _Reader:
    """Reads the rows of one table."""

    def __init__(self, source: str, longest: int, worker_parameter: str) -> None:
        self.problems: list[Problem] = []
        self._source, self._longest = source, longest
        self._names: dict[str, int] = {}  # in lower case → cell
        self._width = 0
        self._workers = {**_WORKERS}
        if worker_parameter:
            self._workers = {worker_parameter.lower(): worker_parameter, **_WORKERS}
        self._worker = self._assignment = self._state = ""
        self._numbered: dict[str, list[tuple[str, int]]] = {}  # name → number and cell
        self._assignments: list[Assignment] = []
        self._characters = 0
        self._answers = self._rejected = self._unfinished = self._empty = self._comments = 0
        self._forms: dict[str, str | LanguageError] = {}  # as it is written → canonical
        self._commands: dict[str, str] = {}

    def read_head(self, cells: Sequence[str], line: int) -> None:
        """Take the names of the columns. Raises LanguageError where this is no table of results."""
        place = Position(self._source, max(line, 1))
        names = [cell.strip().lower() for cell in cells]
        if len(names) > MOST_COLUMNS:
            sentence = f"the table has {len(names):,} columns; {MOST_COLUMNS:,} is the limit"
            raise LanguageError(sentence, place)
        for cell, name in enumerate(names):
            if name in self._names:
                raise LanguageError(
                    f"two columns are called {cells[cell].strip()[:40]}",
                    Position(self._source, place.line, cell + 1),
                    "rename one of them",
                )
            self._names[name] = cell
            if match := _NUMBERED.fullmatch(name):
                self._numbered.setdefault(match["name"], []).append((match["number"], cell))
        for name, most in _MOST_NUMBERED.items():
            if len(self._numbered.get(name, ())) > most:
                sentence = f"the table has more than {most} columns {name.capitalize()}"
                raise LanguageError(sentence, place, "split the tasks up")
        if not {"answer.utterance", "answer.custom"} & self._numbered.keys():
            hint = "results have WorkerId, Input.command1, Answer.utterance1 and so on"
            raise LanguageError("this is no table of results", place, hint)
        self._worker = self._first_of(self._workers)
        self._assignment, self._state = self._first_of(_ASSIGNMENTS), self._first_of(_STATES)
        if not self._worker:
            hint = "it says who answered, and becomes a pseudonym"
            raise LanguageError("there is no column WorkerId", place, hint)
        for number, cell in self._numbered.get("answer.utterance", ()):
            if f"input.command{number}" not in self._names:
                raise LanguageError(
                    f"Answer.utterance{number} has no column Input.command{number}",
                    Position(self._source, place.line, cell + 1),
                    "add the prompts that it answers",
                )
        self._width = len(names)

    def read_row(self, cells: Sequence[str], line: int) -> None:
        """Take one assignment. Raises LanguageError where the table has too many."""
        if len(cells) != self._width:
            message = f"this row has {len(cells)} cells; the head has {self._width}"
            hint = "put quotation marks around cells with a delimiter or a quotation mark in them"
            self.problems.append(error_at(Position(self._source, line), message, hint))
            return
        state = re.sub(r"[^a-z]", "", self._cell(cells, self._state).lower())
        if state in _REJECTED | _UNFINISHED:
            self._rejected += state in _REJECTED
            self._unfinished += state in _UNFINISHED
            return
        worker = self._cell(cells, self._worker)
        if not worker:
            place = Position(self._source, line, self._names[self._worker] + 1)
            hint = "write who answered, or delete the row"
            self.problems.append(error_at(place, "WorkerId is empty", hint))
            return
        rewrites = tuple(self._rewrites(cells, line))
        free = tuple(self._free_commands(cells, line))
        self._answers += len(rewrites) + len(free)
        if len(self._assignments) == MOST_ASSIGNMENTS or self._answers > MOST_ANSWERS:
            sentence = (
                f"the table has more than {MOST_ASSIGNMENTS:,} rows or {MOST_ANSWERS:,} answers"
            )
            raise LanguageError(sentence, Position(self._source, line), "split it up")
        self._comments += bool(self._cell(cells, "answer.comment"))
        if not rewrites and not free:
            self._empty += 1
            return
        market, key = self._workers[self._worker], self._cell(cells, self._assignment)
        seconds = self._seconds(cells, line)
        self._assignments.append(Assignment(line, market, worker, key, seconds, rewrites, free))

    def table(self) -> CrowdTable:
        return CrowdTable(
            tuple(self._assignments),
            self._rejected,
            self._unfinished,
            self._empty,
            self._comments,
            tuple(sorted(self.problems)),
        )

    def _first_of(self, names: Iterable[str]) -> str:
        """Return the first of ``names`` that a column has; empty where none has."""
        return next((name for name in names if name in self._names), "")

    def _cell(self, cells: Sequence[str], name: str) -> str:
        at = self._names.get(name)
        return "" if at is None else normalise_line(_FORMULA_GUARD.sub("", cells[at]))

    def _rewrites(self, cells: Sequence[str], line: int) -> Iterator[CrowdRewrite]:
        for number, at in self._numbered.get("answer.utterance", ()):
            text = self._answer(cells, f"Answer.utterance{number}", at, line)
            if not text:
                continue
            column = self._names[f"input.command{number}"]
            command = self._commands.get(cells[column])
            if command is None:
                command = self._cell(cells, f"input.command{number}")
                self._commands[cells[column]] = command
            if not command:
                place = Position(self._source, line, column + 1)
                message = f"Input.command{number} is empty, and its answer is not"
                self.problems.append(error_at(place, message, "write the command"))
                continue
            forms = [
                self._form(cells, line, f"{each}{number}") for each in ("parse", "parse_ground")
            ]
            if None not in forms:
                yield CrowdRewrite(at + 1, command, forms[0] or "", forms[1] or "", text)

    def _free_commands(self, cells: Sequence[str], line: int) -> Iterator[str]:
        for number, at in self._numbered.get("answer.custom", ()):
            if text := self._answer(cells, f"Answer.custom{number}", at, line):
                yield text

    def _answer(self, cells: Sequence[str], name: str, at: int, line: int) -> str:
        """Return what somebody wrote; empty, with a warning, where it is too long."""
        text = normalise_line(_FORMULA_GUARD.sub("", cells[at]))
        if len(text) <= self._longest:
            return text
        place = Position(self._source, line, at + 1)
        message = f"{name} has {len(text):,} characters; left out"
        self.problems.append(warning_at(place, message, f"{self._longest:,} is the limit"))
        return ""

    def _form(self, cells: Sequence[str], line: int, name: str) -> str | None:
        """Return a form in its canonical text, empty without one; None, with an error, where it cannot be read."""
        at = self._names.get(f"input.{name}")
        written = "" if at is None else cells[at].strip()
        if at is None or not written:
            return ""
        if written not in self._forms:
            self._characters += len(written)
            if self._characters > MOST_OF_FORMS:
                sentence = f"the forms of the table have more than {MOST_OF_FORMS:,} characters"
                raise LanguageError(sentence, Position(self._source, line, at + 1), "split it up")
            try:
                self._forms[written] = canonical_text(read_form(normalise_line(written)))
            except LanguageError as error:
                self._forms[written] = error
        form = self._forms[written]
        if isinstance(form, str):
            return form
        place = Position(self._source, line, at + 1)
        self.problems.append(error_at(place, f"Input.{name}: {form.message}", form.hint))
        return None

    def _seconds(self, cells: Sequence[str], line: int) -> float | None:
        written = self._cell(cells, "worktimeinseconds")
        if not written:
            return None
        try:
            seconds = float(written)
        except ValueError:
            seconds = -1.0
        if 0 <= seconds <= MOST_SECONDS:
            return seconds
        place = Position(self._source, line, self._names["worktimeinseconds"] + 1)
        message = "WorkTimeInSeconds is no number of seconds within a day; taken as not known"
        self.problems.append(warning_at(place, message, "write a number such as 71"))
        return None
