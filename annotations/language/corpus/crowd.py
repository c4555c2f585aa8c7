"""Read the results of a paraphrasing task on a crowd-sourcing site as triples.

docs/reference/formats.md, Crowd tables, describes them.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping
from io import StringIO

from annotations.language.corpus.written_pairs import GroundedTriple, RecordFile
from annotations.language.decoding import read_text
from annotations.language.errors import LanguageError, Position, Problem, error_at, warning_at
from annotations.language.forms import read_form

_ANSWER = re.compile(r"answer\.utterance(?P<number>\d{1,3})")
_DELIMITERS = ",;\t"
_DECLARED = re.compile(r"\"?sep=([,;\t])\"?\n", re.IGNORECASE)  # Excel's first line


def is_crowd_file(name: str) -> bool:
    return name.lower().endswith((".csv", ".tsv"))


def read_crowd_results(data: bytes, source: str) -> RecordFile[GroundedTriple]:
    """Read a table with ``Input.command1``, ``Input.parse_ground1``, ``Answer.utterance1`` and so on.

    Its cells are separated by commas, semicolons or tabs, or as Excel's line ``sep=;`` says. Rows whose
    ``AssignmentStatus`` is Rejected, blank rows and empty answers are left out. Errors are returned, not
    raised; a table of another kind gives one warning.
    """
    try:
        text, problems = read_text(data, source)
    except LanguageError as error:
        return RecordFile((), (error.problem,))
    records: list[GroundedTriple] = []
    declared = _DECLARED.match(text)
    if declared:
        text = text[declared.end() - 1 :]  # the line stays, empty, so that lines keep their numbers
    head, _, _ = text.lstrip().partition("\n")
    delimiter = declared[1] if declared else max(_DELIMITERS, key=head.count)
    rows = csv.reader(StringIO(text, newline=""), delimiter=delimiter, strict=True)
    try:
        names = [cell.strip().lower() for cell in next(filter(None, rows), [])]
        numbers = [match["number"] for match in map(_ANSWER.fullmatch, names) if match]
        wanted = [
            f"input.{kind}{number}" for number in numbers for kind in ("command", "parse_ground")
        ]
        if not numbers or not set(wanted) <= set(names):
            hint = "a table of results has Answer.utterance1, Input.command1, Input.parse_ground1 and so on"
            return RecordFile((), (warning_at(Position(source), "not a table of results", hint),))
        begun = rows.line_num + 1
        for cells in rows:
            place, begun = Position(source, begun), rows.line_num + 1
            if not any(cell.strip() for cell in cells):
                continue
            if len(cells) != len(names):
                message = f"this row has {len(cells)} cells; the head has {len(names)}"
                problems.append(error_at(place, message, "put quotation marks around the cells"))
                continue
            row = dict(zip(names, (" ".join(cell.split()) for cell in cells), strict=True))
            if row.get("assignmentstatus", "").lower() != "rejected":
                records += _answers(row, numbers, place, problems)
    except csv.Error:
        place = Position(source, max(rows.line_num, 1))
        sentence = "the table breaks off inside a cell, or has one too long"
        problems.append(error_at(place, sentence, "close its quotation mark"))
    return RecordFile(tuple(records), tuple(sorted(problems)))


def _answers(
    row: Mapping[str, str], numbers: list[str], place: Position, problems: list[Problem]
) -> Iterator[GroundedTriple]:
    for number in numbers:
        utterance, command = row[f"answer.utterance{number}"], row[f"input.command{number}"]
        if not utterance:
            continue
        try:
            form = read_form(row[f"input.parse_ground{number}"])
        except LanguageError as error:
            sentence = f"Input.parse_ground{number}: {error.message}"
            problems.append(error_at(place, sentence, error.hint))
            continue
        if not command:
            problems.append(error_at(place, f"Input.command{number} is empty", "write the command"))
            continue
        yield GroundedTriple(utterance, command, form, place)
