"""Say which rows of a competition's folder the published generators lose, and how to write them so that they do not.

RoboCup@Home publishes the generator of its commands with each season's rules. It reads the folder with regular
expressions over the whole text of a file, so that a row depends on the strokes of the rows around it. The patterns
here find what those of 2025 and of April 2026 find, in linear time.
"""

from __future__ import annotations

import re
import unicodedata
from bisect import bisect_right
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import accumulate

from annotations.language.texts import Position, Problem, read_text, warning_at
from annotations.language.texts import singular as one_of
from annotations.language.world.competition_folder import LOCATIONS, NAMES, OBJECTS, ROOMS
from annotations.language.world.entities import Entity, Ontology

_NAME = re.compile(r"\|\s*+([A-Za-z]++)\s*+\|")
_ROOM = re.compile(r"\|\s*+(\w++ \w*+)\s*+\|")
_OBJECT = re.compile(r"\|\s*+(\w++)\s*+\|")
_LOCATION_2025 = re.compile(r"\|\s*+[0-9]++\s*+\|([A-Za-z,\s()]++)\|")
_LOCATION_2026 = re.compile(r"\|\s*+[0-9]++\s*+\|([A-Za-z\s()]++)\|[A-Za-z\s]*+\|")
_CLASS_2025 = re.compile(r"# Class \s*+([\w,\s()]++)")
_CLASS_2026 = re.compile(r"# Class\s++")
_HEADING_2026 = re.compile(r"(\w++)\s*+\((\w++)\)")

_ONE_NAME = re.compile(r"[A-Za-z]++")
_LETTERS = re.compile(r"[A-Za-z ()]++")
_LETTERS_OR_NOTHING = re.compile(r"[A-Za-z ]*+")
_WORDS = re.compile(r"\w++( \w++)?")
_WORD = re.compile(r"\w++")
_NO_WORD = re.compile(r"\W++")
_PLACE, _HEAD = "(p)", "head"
_HEAD_OF_OBJECTS = "Objectname"
_CLOSE_ALL = "write | at both ends of the row, and of the rows around it"


@dataclass(frozen=True, slots=True)
class ReadRow:
    """A name that a generator reads at ``start``, and what it reads beside it: ``(p)``, or the singular of a class.

    ``end`` is behind the last character that the row uses up; no other row can use it. The row that is taken for
    the head has ``head`` beside it.
    """

    start: int
    end: int
    text: str
    beside: str = ""


@dataclass(frozen=True, slots=True)
class LostRow:
    """A row that ``generator`` does not read, or reads as ``misread``; ``hint`` says what to write."""

    generator: str
    entity: Entity
    misread: str
    hint: str


Reader = Callable[[str], Iterator[ReadRow]]


def _read_column(pattern: re.Pattern[str]) -> Reader:
    """Return a reader of the cells that match. The first of them is the head."""

    def read(text: str) -> Iterator[ReadRow]:
        for number, cell in enumerate(pattern.finditer(text)):
            yield ReadRow(cell.start(1), cell.end(), cell[1].strip(), "" if number else _HEAD)

    return read


def _read_locations(pattern: re.Pattern[str]) -> Reader:
    def read(text: str) -> Iterator[ReadRow]:
        for row in pattern.finditer(text):
            name = row[1].strip()
            start = row.start(1) + len(row[1]) - len(row[1].lstrip())
            beside = _PLACE if name.endswith(_PLACE) else ""
            yield ReadRow(start, row.end(), " ".join(name.replace(_PLACE, "").split()), beside)

    return read


def _read_objects(text: str, start: int, end: int) -> Iterator[ReadRow]:
    for cell in _OBJECT.finditer(text, start, end):
        if cell[1] != _HEAD_OF_OBJECTS:
            yield ReadRow(cell.start(1), cell.end(), " ".join(cell[1].replace("_", " ").split()))


def _read_objects_of_2025(text: str) -> Iterator[ReadRow]:
    """Yield the classes, and the objects of the whole file."""
    for heading in _CLASS_2025.finditer(text):
        names = heading[1].replace("(", "").replace(")", "").split()
        if len(names) > 1:
            plural, singular = (name.replace("_", " ") for name in names[:2])
            yield ReadRow(heading.start(), heading.end(), plural, singular)
    yield from _read_objects(text, 0, len(text))


def _read_objects_of_2026(text: str) -> Iterator[ReadRow]:
    """Yield the classes that have a singular, each with its objects."""
    headings = list(_CLASS_2026.finditer(text))
    ends = [*(heading.start() for heading in headings[1:]), len(text)]
    for heading, end in zip(headings, ends, strict=False):
        names = _HEADING_2026.match(text, heading.end(), end)
        if names is not None:
            plural, singular = (name.replace("_", " ").strip() for name in names.groups())
            yield ReadRow(heading.start(), names.end(), plural, singular)
            yield from _read_objects(text, heading.end(), end)


# Generator → file → what it reads there.
_COLUMNS = {NAMES: _read_column(_NAME), ROOMS: _read_column(_ROOM)}
PUBLISHED_GENERATORS: Mapping[str, Mapping[str, Reader]] = {
    "2025": {
        **_COLUMNS,
        LOCATIONS: _read_locations(_LOCATION_2025),
        OBJECTS: _read_objects_of_2025,
    },
    "April 2026": {
        **_COLUMNS,
        LOCATIONS: _read_locations(_LOCATION_2026),
        OBJECTS: _read_objects_of_2026,
    },
}


def lost_rows(files: Mapping[str, bytes], ontology: Ontology) -> Iterator[LostRow]:
    """Yield the rows that a published generator does not read as ``read_competition`` does, by generator.

    Args:
        files: one of ``COMPETITION_FILES`` → content, without errors.
        ontology: what ``read_competition`` says of them.
    """
    by_file: dict[str, dict[int, Entity]] = defaultdict(dict)
    for entity in ontology.entities:
        by_file[entity.position.source].setdefault(entity.position.line, entity)
    texts = {name: _Text(read_text(files[name], name)[0]) for name in by_file}
    for generator, readers in PUBLISHED_GENERATORS.items():
        for name, entities in by_file.items():
            reading = _Reading(texts[name], readers[name](texts[name].whole))
            for entity in entities.values():
                row = reading.row_of(entity)
                if row is None or (row.text, row.beside) != _expected(entity):
                    misread = _say_read(row, entity) if row and row.beside != _HEAD else ""
                    yield LostRow(generator, entity, misread, reading.hint_for(entity))


def warnings_of_lost(lost: Iterable[LostRow]) -> tuple[Problem, ...]:
    """Return a warning for each row that is lost, and one alone for generators of which it says the same."""
    generators: dict[tuple[Position, str, str, str], list[str]] = defaultdict(list)
    for row in lost:
        kind = "class" if row.entity.entity_class == "category" else row.entity.entity_class
        said = f"the {kind} {row.entity.text}"
        generators[row.entity.position, said, row.misread, row.hint].append(row.generator)
    problems = []
    for (position, said, misread, hint), names in generators.items():
        who = f"the generator{'s' * (len(names) > 1)} of {' and of '.join(names)}"
        s = "" if len(names) > 1 else "s"
        does = f"read{s} {said} as “{misread}”" if misread else f"lose{s} {said}"
        problems.append(warning_at(position, f"{who} {does}", hint))
    return tuple(sorted(problems))


def _expected(entity: Entity) -> tuple[str, str]:
    """Return what a generator has to read of a row: its name, and what stands beside it."""
    if entity.entity_class == "category":
        return entity.text, entity.attribute("singular") or entity.text
    is_placement = entity.entity_class == "location" and entity.is_set("isPlacement")
    return entity.text, _PLACE if is_placement else ""


def _say_read(row: ReadRow, entity: Entity) -> str:
    if entity.entity_class == "category":
        return f"{row.text} ({row.beside})"
    return f"{row.text} {row.beside}".strip()


class _Text:
    """A text with its lines, and where each of them starts."""

    def __init__(self, text: str) -> None:
        self.whole, self.lines = text, text.split("\n")
        # Faster than Offsets, which looks at every character: a file may have millions.
        self._starts = [0, *accumulate(len(line) + 1 for line in self.lines)]

    def start_of(self, line: int) -> int:
        return self._starts[line - 1]

    def line_at(self, index: int) -> int:
        return bisect_right(self._starts, index)


class _Reading:
    """What a generator reads in a text, and what there is to write for a row that it does not read."""

    def __init__(self, text: _Text, rows: Iterable[ReadRow]) -> None:
        self._text, self._lines = text, text.lines
        self._rows: dict[int, ReadRow] = {}
        self._users: dict[int, int] = {}  # index of a stroke → the line of the row that it ends
        self._classes: set[str] = set()
        for row in rows:
            line = text.line_at(row.start)
            self._rows.setdefault(line, row)
            self._users[row.end - 1] = line
            if self._lines[line - 1].lstrip().startswith("#"):
                self._classes.add(row.text)

    def row_of(self, entity: Entity) -> ReadRow | None:
        return self._rows.get(entity.position.line)

    def hint_for(self, entity: Entity) -> str:
        row = self.row_of(entity)
        if row is not None and row.beside == _HEAD:
            return "write | Names | above it: the first row that is read is taken for the head"
        return self._hint_for(entity) or _CLOSE_ALL

    def _hint_for(self, entity: Entity) -> str:
        match entity.entity_class:
            case "name":
                return (
                    "" if _ONE_NAME.fullmatch(entity.text) else _write_with(_ONE_NAME, entity.text)
                )
            case "room":
                return self._hint_for_room(entity)
            case "location":
                return self._hint_for_location(entity)
            case "object":
                return self._hint_for_object(entity)
        return _write_class(entity.text, entity.attribute("singular"))

    def _hint_for_room(self, room: Entity) -> str:
        if not _WORDS.fullmatch(room.text):
            return "write one or two words of letters and digits"
        return f"write | {room.text} | with a blank before the second stroke, and close the rows around it"

    def _hint_for_location(self, location: Entity) -> str:
        line = location.position.line
        number, *others = (cell.strip() for cell in self._cells(line))
        beside = others[1:]
        if self.row_of(location) is not None:
            return "end the second cell with (p); the class belongs into the third"
        if not _LETTERS.fullmatch(location.text):
            return _write_with(_LETTERS, location.text)
        if not number.isdecimal():
            return "write a number into the first cell"
        if beside and not _LETTERS_OR_NOTHING.fullmatch(beside[0]):
            return "write one class into the third cell, in letters and blanks, or nothing"
        first_stroke = self._text.start_of(line) + self._lines[line - 1].find("|")
        above = self._users.get(first_stroke, line)
        if above != line or len(beside) < 2:
            which = "the row above" if above != line else "this row"
            return f"end {which} with an empty cell: {self._closed(above)}"
        return ""

    def _hint_for_object(self, item: Entity) -> str:
        written = self._cells(item.position.line)[0].strip()
        if not _WORD.fullmatch(written):
            name = _NO_WORD.sub("_", item.text).strip("_")
            return f"write {name}" if name else "write letters, digits and _"
        if item.attribute("category") not in self._classes:
            return f"{_write_class(item.attribute('category') or '')} above it"
        return ""

    def _cells(self, line: int) -> list[str]:
        """Return the first texts between the strokes of a line; the last is what stands behind these strokes."""
        return self._lines[line - 1].strip().removeprefix("|").split("|", 3)

    def _closed(self, line: int) -> str:
        written = self._lines[line - 1].strip()
        return f"{written} |" if written.endswith("|") else f"{written} | |"


def _write_class(plural: str, singular: str | None = None) -> str:
    names = (name.replace(" ", "_") for name in (plural, singular or one_of(plural.casefold())))
    return "write # Class {} ({})".format(*names)


def _write_with(pattern: re.Pattern[str], text: str) -> str:
    """Return the hint to write ``text`` without accents, where that matches."""
    parts = unicodedata.normalize("NFKD", text)
    plain = "".join(each for each in parts if not unicodedata.combining(each))
    return f"write {plain}" if pattern.fullmatch(plain) else "write it with the letters A to Z"
