"""Read pair files and grounded triples with positions, and write pair files (FORMATS §5, §6)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from annotations.language.decoding import decode
from annotations.language.errors import LanguageError, Position, Problem, error_at
from annotations.language.forms import Form, canonical_text, read_form

# Part → file name, and folder → (source, criterion) of the published corpus.
PART_FILES = {"train": "train.txt", "validation": "val.txt", "test": "test.txt"}
CORPUS_FOLDERS = {
    "gen": ("generated", "command"),
    "para": ("paraphrased", "command"),
    "gen_logical": ("generated", "logical_form"),
    "para_logical": ("paraphrased", "logical_form"),
}
TRIPLES_FILE = "paraphrasings.txt"


@dataclass(frozen=True, slots=True)
class WrittenPair:
    """A command and its form as they stand in a file; ``position`` is that of the command."""

    utterance: str
    written_form: str
    form: Form
    position: Position

    @property
    def canonical_form(self) -> str:
        return canonical_text(self.form)


@dataclass(frozen=True, slots=True)
class GroundedTriple:
    """A paraphrase, the generated command that it rewrites, and the grounded form of both."""

    paraphrase: str
    command: str
    form: Form
    position: Position

    @property
    def canonical_form(self) -> str:
        """The form with single spaces, also inside the quotation marks."""
        return canonical_text(self.form)


Record = TypeVar("Record", WrittenPair, GroundedTriple)


@dataclass(frozen=True, slots=True)
class RecordFile(Generic[Record]):
    """The records of a file, in order, and everything that is wrong with it (all errors)."""

    records: tuple[Record, ...]
    problems: tuple[Problem, ...]


def read_pairs(data: bytes, source: str) -> RecordFile[WrittenPair]:
    """Read alternating lines: command, logical form. Errors are returned, not raised."""
    records: list[WrittenPair] = []
    problems: list[Problem] = []
    forms: dict[str, tuple[str, Form]] = {}  # many commands share one, and its text
    for (command, written), place in _group_lines(data, source, 2, problems):
        if written not in forms and (form := _form(written, place, 1, problems)) is not None:
            forms[written] = written, form
        if written in forms and _is_written(command, place, 0, problems):
            records.append(WrittenPair(command, *forms[written], place))
    return RecordFile(tuple(records), tuple(sorted(problems)))


def read_triples(data: bytes, source: str) -> RecordFile[GroundedTriple]:
    """Read records of three lines: paraphrase, command, grounded form. Errors are returned, not raised."""
    records: list[GroundedTriple] = []
    problems: list[Problem] = []
    for (paraphrase, command, written), place in _group_lines(data, source, 3, problems):
        form = _form(written, place, 2, problems)
        has_paraphrase = _is_written(paraphrase, place, 0, problems)
        is_whole = _is_written(command, place, 1, problems) and has_paraphrase
        if form is not None and is_whole:
            records.append(GroundedTriple(paraphrase, command, form, place))
    return RecordFile(tuple(records), tuple(sorted(problems)))


def write_pairs(pairs: Iterable[tuple[str, str]]) -> Iterator[str]:
    """Stream the lines of a pair file in the given order, each with its line feed."""
    for utterance, form in pairs:
        yield f"{utterance}\n{form}\n"


def by_length(pairs: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
    """Sort pairs as the published files do: by the number of characters of the command."""
    return sorted(pairs, key=lambda pair: len(pair[0]))


def _group_lines(
    data: bytes, source: str, size: int, problems: list[Problem]
) -> Iterator[tuple[Sequence[str], Position]]:
    """Yield groups of ``size`` lines with the position of the first; leftover lines are a problem."""
    try:
        lines = decode(data, source).split("\n")
    except LanguageError as error:
        problems.append(error.problem)
        return
    if not lines[-1]:
        lines.pop()
    whole = len(lines) - len(lines) % size
    if whole < len(lines):
        message = f"the file has {len(lines)} lines, which is not a multiple of {size}"
        hint = "a line is missing or extra, here or above"
        problems.append(error_at(Position(source, len(lines)), message, hint))
    for start in range(0, whole, size):
        yield lines[start : start + size], Position(source, start + 1)


def _form(written: str, place: Position, row: int, problems: list[Problem]) -> Form | None:
    try:
        return read_form(written, _below(place, row))
    except LanguageError as error:
        problems.append(error.problem)
        return None


def _is_written(text: str, place: Position, row: int, problems: list[Problem]) -> bool:
    if not text.strip():
        problems.append(error_at(_below(place, row), "there is no command here", "write one"))
    return bool(text.strip())


def _below(place: Position, rows: int) -> Position:
    return Position(place.source, place.line + rows)
