"""Read pair files and grounded triples with positions, and write pair files (docs/reference/formats.md)."""

from __future__ import annotations

import codecs
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from annotations.language.forms import Form, canonical_text, read_form
from annotations.language.texts import (
    LanguageError,
    Position,
    Problem,
    TextChanges,
    decode,
    error_at,
    normalise_record,
    require_something,
    say_changes,
    say_count,
    warning_at,
)

# Part → file name, and folder → (source, criterion): of the published corpus, and what others wrote.
PART_FILES = {"train": "train.txt", "validation": "val.txt", "test": "test.txt"}
CORPUS_FOLDERS = {
    "gen": ("generated", "command"),
    "para": ("paraphrased", "command"),
    "gen_logical": ("generated", "logical_form"),
    "para_logical": ("paraphrased", "logical_form"),
    "model": ("model", "command"),
    "said": ("said", "command"),
    "model_logical": ("model", "logical_form"),
    "said_logical": ("said", "logical_form"),
}
TRIPLES_FILE = "paraphrasings.txt"
_FORM_STARTS = ("(", "UNKNOWN")
_NOT_EXPORTED = "an export does not have it"
_EXPORTED_CHANGED = "an export has the line as it is read"
# File name → part; the validation part has several usual names.
PARTS = {file: part for part, file in PART_FILES.items()} | dict.fromkeys(
    ("valid.txt", "dev.txt", "validation.txt"), "validation"
)


def is_corpus_path(path: str) -> bool:
    """Return whether a file is one of the published corpus by its folder and name, in any case of letters."""
    _, folder, name = f"//{path.lower()}".rsplit("/", 2)
    return folder in CORPUS_FOLDERS and name in PARTS


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
    """The records of a file, in order, and everything that is wrong with it.

    Warnings say what an export will not have, and which command has two forms.
    """

    records: tuple[Record, ...]
    problems: tuple[Problem, ...]


def read_pairs(data: bytes, source: str) -> RecordFile[WrittenPair]:
    """Read alternating lines: command, logical form. Errors are returned, not raised.

    Blank lines between pairs and at the end are left out.
    """
    records: list[WrittenPair] = []
    problems: list[Problem] = []
    forms: dict[str, tuple[str, Form]] = {}  # many commands share one, and its text
    for (command, written), (place, below) in _group_lines(data, source, 2, problems):
        if written not in forms and (form := _form(written, below, problems)) is not None:
            forms[written] = written, form
        if _require_written(command, place, problems) and written in forms:
            records.append(WrittenPair(command, *forms[written], place))
    problems += contradictions(records)
    return RecordFile(tuple(records), tuple(sorted(problems)))


def contradictions(records: Iterable[WrittenPair]) -> Iterator[Problem]:
    """Yield a warning for each command that has another form than where it stands first."""
    first: dict[str, WrittenPair] = {}
    texts: dict[str, str] = {}  # form as it is written → canonical text
    for record in records:
        earlier = first.setdefault(record.utterance, record)
        if earlier.written_form == record.written_form:
            continue
        for each in (earlier, record):
            if each.written_form not in texts:
                texts[each.written_form] = each.canonical_form
        if texts[earlier.written_form] != texts[record.written_form]:
            yield warning_at(
                record.position,
                f"this command has another form in line {earlier.position.line}",
                "correct one of the two; both are kept",
            )


def read_triples(data: bytes, source: str) -> RecordFile[GroundedTriple]:
    """Read records of three lines: paraphrase, command, grounded form. Errors are returned, not raised."""
    records: list[GroundedTriple] = []
    problems: list[Problem] = []
    for (paraphrase, command, written), places in _group_lines(data, source, 3, problems):
        place = places[0]
        form = _form(written, places[2], problems)
        has_paraphrase = _require_written(paraphrase, place, problems)
        is_whole = _require_written(command, places[1], problems) and has_paraphrase
        if form is not None and is_whole:
            records.append(GroundedTriple(paraphrase, command, form, place))
    return RecordFile(tuple(records), tuple(sorted(problems)))


def write_pairs(pairs: Iterable[tuple[str, str]]) -> Iterator[str]:
    """Stream the lines of a pair file in the given order, each with its line feed."""
    for utterance, form in pairs:
        yield f"{utterance}\n{form}\n"


def write_triples(triples: Iterable[tuple[str, str, str]]) -> Iterator[str]:
    """Stream records of paraphrase, command and grounded form, each as three lines."""
    for paraphrase, command, form in triples:
        yield f"{paraphrase}\n{command}\n{form}\n"


def by_length(pairs: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
    """Sort pairs as the published files do: by the number of characters of the command."""
    return sorted(pairs, key=lambda pair: len(pair[0]))


def _group_lines(
    data: bytes, source: str, size: int, problems: list[Problem]
) -> Iterator[tuple[Sequence[str], Sequence[Position]]]:
    """Yield groups of ``size`` lines with their positions. The last line of each is a form.

    A blank line is left out where the next one goes on as expected; otherwise it stands for the line that
    is missing there. Leftover lines are a problem.
    """
    try:
        written = decode(data, source)
        text = normalise_record(written)
        require_something(text, source)
    except LanguageError as error:
        problems.append(error.problem)
        return
    lines = text.split("\n")
    problems += _warn_of_normalising(written, lines, source) if text != written else []
    if written.endswith("\n"):
        lines.pop()
    if data.startswith(codecs.BOM_UTF8):
        sentence = "the file begins with a byte-order mark"
        problems.append(warning_at(Position(source), sentence, _NOT_EXPORTED))
    if b"\r" in data:
        sentence = "lines end with a carriage return; an export ends them with a line feed alone"
        problems.append(warning_at(Position(source), sentence))
    if not data.endswith((b"\n", b"\r")):
        end = Position(source, len(lines), len(lines[-1]) + 1)
        sentence = "the last line has no line end; an export gives it one"
        problems.append(warning_at(end, sentence))
    group: list[tuple[str, Position]] = []
    following: list[str | None] = []  # for each line the next one that is not blank
    after = None
    for line in reversed(lines):
        following.append(after)
        after = line if line.strip() else after
    following = following[::-1]
    left_out: list[int] = []
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            after = following[number - 1]
            is_form_next = after is not None and after.lstrip().startswith(_FORM_STARTS)
            is_form_due = len(group) == size - 1
            if (after is None and not group) or (after is not None and is_form_next == is_form_due):
                left_out.append(number)
                continue
        group.append((line, Position(source, number)))
        if len(group) == size:
            yield [text for text, _ in group], [place for _, place in group]
            group = []
    if group:
        count = len(lines) - len(left_out)
        message = f"the file has {count} lines, which is not a multiple of {size}"
        hint = "a line is missing or extra, here or above"
        problems.append(error_at(group[-1][1], message, hint))
    if left_out:
        message = f"{say_count(len(left_out), 'blank line')} left out, from here on"
        problems.append(warning_at(Position(source, left_out[0]), message, _NOT_EXPORTED))


def _warn_of_normalising(written: str, lines: Sequence[str], source: str) -> list[Problem]:
    """Return a warning for each line whose visible text normalising changes, and one for odd blanks."""
    records = zip(written.split("\n"), lines, strict=True)
    changed = [
        (Position(source, number), TextChanges.of(record))
        for number, (record, line) in enumerate(records, start=1)
        if record != line
    ]
    warnings = say_changes([each for each in changed if each[1]], _EXPORTED_CHANGED)
    if blanks := [place for place, changes in changed if not changes]:
        sentence = f"odd blanks are plain spaces in {say_count(len(blanks), 'line')}, from here on"
        warnings.append(warning_at(blanks[0], sentence, _EXPORTED_CHANGED))
    return warnings


def _form(written: str, place: Position, problems: list[Problem]) -> Form | None:
    try:
        return read_form(written, place)
    except LanguageError as error:
        problems.append(error.problem)
        return None


def _require_written(text: str, place: Position, problems: list[Problem]) -> bool:
    if not text.strip():
        problems.append(error_at(place, "there is no command here", "write one"))
    return bool(text.strip())
