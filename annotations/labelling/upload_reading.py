"""Read uploaded utterances: JSON Lines, JSON, tables, pairs of command and form, plain text.

The format is recognised by what the text looks like, not by the name of the file. Nothing is guessed away:
what cannot be read is named with its line.
"""

from __future__ import annotations

import codecs
import csv
import io
import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import islice
from typing import Any, Literal

from charset_normalizer import from_bytes

from annotations.labelling.foreign_formats import (
    FORM_NAMES,
    form_of_task,
    join_fragments,
    take_utterances,
)
from annotations.language.texts import (
    ENCODINGS,
    LanguageError,
    Offsets,
    Position,
    Problem,
    error_at,
    has_half_character,
    normalise_line,
)

MOST_BYTES = 2_000_000  # of one upload
MOST_COLUMNS = 200
MOST_PROBLEMS = 50  # that are named; the rest is counted
LONGEST_VALUE = 20_000  # characters of a cell that are kept: more than any utterance or form has
# Bytes or characters from which an encoding and a delimiter are recognised.
LONGEST_SAMPLE = 100_000
TOO_DEEP = "this nests too deep, or a number in it is too long"


class UploadFormat(StrEnum):
    """How an upload is written. ``PAIRS``: lines of command and form in turn, or triples. ``TAKEN``: out of a
    file of another program (``foreign_formats``)."""

    TEXT = "text"
    JSONL = "jsonl"
    JSON = "json"
    CSV = "csv"
    TSV = "tsv"
    PAIRS = "pairs"
    TAKEN = "taken"


FORMAT_NAMES = {
    UploadFormat.TEXT: "Plain text, one utterance a line",
    UploadFormat.JSONL: "JSON Lines",
    UploadFormat.JSON: "JSON",
    UploadFormat.CSV: "Table (CSV)",
    UploadFormat.TSV: "Table with tabs (TSV)",
    UploadFormat.PAIRS: "Pairs of command and logical form",
    UploadFormat.TAKEN: "File of another program (Rasa, snips, subtitles, CoNLL, Kaldi)",
}
TABLES = (UploadFormat.CSV, UploadFormat.TSV)

# What a column with utterances is called, the surest name first.
TEXT_NAMES = (
    *("utterance", "utt", "text", "sentence", "command", "query", "paraphrase", "transcript"),
    *(
        "transcription",
        "instruction",
        "phrase",
        "said",
        "input",
        "question",
        "message",
        "content",
        "data",
    ),
)
_USUAL_NAMES = (
    "id",
    "nr",
    "no",
    "number",
    "label",
    "labels",
    "intent",
    "category",
    "class",
    "split",
)
_BETWEEN_WORDS = re.compile(r"[.\s_-]")
_CROWD_HEAD = re.compile(r"[^\n]*\bAnswer\.(?:utterance|custom)\d", re.IGNORECASE)
# What sentences do not have: brackets, markup, identifiers and paths.
_UNSAID = re.compile(r"[\[\](){}<>_=|\\/@#]|\w:\w")
_LETTERS_OF_WORD, _MOST_WORDS = 5, 8
# The apostrophe with which exports keep spreadsheets from reading a formula.
_FORMULA_GUARD = re.compile(r"\A'(?=[=+@-])")
_RULER = re.compile(r":?-{2,}:?")  # a cell of the line below the head of a table in Markdown

# The first bytes of what is no text, with what to do about it.
SIGNATURES = {
    b"PK\x03\x04": ("a zip archive or an Excel or Word file", "save the sheet as CSV (UTF-8)"),
    b"\xd0\xcf\x11\xe0": ("an old Excel or Word file", "save the sheet as CSV (UTF-8)"),
    b"%PDF": ("a PDF", "copy its text and paste it"),
    b"\x1f\x8b": ("packed with gzip", "unpack it first"),
    b"BZh": ("packed with bzip2", "unpack it first"),
    b"\xfd7zXZ": ("packed with xz", "unpack it first"),
    b"7z\xbc\xaf": ("a 7z archive", "unpack it first"),
    b"Rar!": ("a RAR archive", "unpack it first"),
    b"PAR1": ("a Parquet file", "download it as JSON Lines or CSV"),
    b"SQLite format 3": ("a database", "export the texts as CSV"),
    b"\x89PNG": ("a picture", "send text"),
    b"\xff\xd8\xff": ("a picture", "send text"),
    b"GIF8": ("a picture", "send text"),
    b"RIFF": ("sound or a picture", "send text"),
    b"OggS": ("sound", "send what was said as text"),
    b"ID3": ("sound", "send what was said as text"),
    b"{\\rtf": ("a rich text file", "save it as plain text (UTF-8)"),
}
BOMS = {b"\xef\xbb\xbf": "utf-8", b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}


@dataclass(frozen=True, slots=True)
class UploadRow:
    """One row of an upload: ``line`` is where it begins (for JSON: which item it is), from 1."""

    line: int
    values: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Sheet:
    """What was read of an upload.

    ``column`` has the texts; it ``is_column_sure`` where its name says so, or where there is only one.
    ``form_column`` has logical forms, and is empty where none has. ``ignored`` are columns that are not
    stored. ``has_head``: the first row of the table names its columns. ``warnings`` are sentences that say
    what was left out or converted. ``problems`` are rows that cannot be read; with one that has no row of
    its own nothing can be.
    """

    format: UploadFormat
    columns: tuple[str, ...] = ()
    records: tuple[UploadRow, ...] = ()
    column: str = ""
    is_column_sure: bool = True
    form_column: str = ""
    has_head: bool = False
    warnings: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()

    @property
    def ignored(self) -> tuple[str, ...]:
        return tuple(each for each in self.columns if each not in (self.column, self.form_column))

    def with_column(self, name: str) -> Sheet:
        """Return the same with the texts in the column called ``name``. Raises LanguageError."""
        if name not in self.columns:
            known = ", ".join(self.columns) or "none"
            raise LanguageError(
                f"there is no column {name[:60]!r}", hint=f"the columns are: {known[:300]}"
            )
        form_column = "" if name == self.form_column else self.form_column
        return replace(self, column=name, form_column=form_column, is_column_sure=True)


def decode_upload(data: bytes, source: str, encoding: str = "") -> tuple[str, str]:
    """Return the text of an upload, with ``\\n`` for every line end, and the name of its encoding.

    Without ``encoding`` a file that is no UTF-8 is read in the encoding that fits it best; who shows it
    says which one, since that is a guess.

    Raises LanguageError for what is no text, has half a character, or is empty.
    """
    place = Position(source)
    if not data.strip():
        raise LanguageError("the file is empty", place, "send one with utterances")
    for start, (what, hint) in SIGNATURES.items():
        if data.startswith(start):
            raise LanguageError(f"the file is {what}, not text", place, hint)
    by_mark = next((name for mark, name in BOMS.items() if data.startswith(mark)), "")
    encoding = by_mark or encoding or _encoding_of(data)
    if encoding not in ENCODINGS:
        hint = f"use {', '.join(ENCODINGS)}"
        raise LanguageError(f"there is no encoding {encoding[:40]!r} here", place, hint)
    codec = encoding
    if encoding == "utf-16" and not by_mark:  # the zeros say which half is first
        codec = "utf-16-be" if data[:1] == b"\0" else "utf-16-le"
    try:
        text = data.decode(codec).removeprefix("\ufeff")
    except UnicodeDecodeError as error:
        hint = "choose another encoding, or save the file as UTF-8"
        line = data[: error.start].count(b"\n") + 1
        message = f"the byte 0x{data[error.start]:02x} is not {ENCODINGS[encoding]}"
        raise LanguageError(message, Position(source, line), hint) from error
    if "\0" in text:
        at = text.index("\0")
        raise LanguageError("the file is binary", Offsets(text, source).position(at), "send text")
    if not text.strip():
        raise LanguageError("the file is empty", place, "send one with utterances")
    return text.replace("\r\n", "\n").replace("\r", "\n"), encoding


def _encoding_of(data: bytes) -> str:
    start = data[:200]
    if 0.4 * len(start) <= start.count(0) <= 0.6 * len(start):  # Latin letters, two bytes each
        return "utf-16"
    try:
        data.decode()
        return "utf-8"
    except UnicodeDecodeError:
        pass
    names = {
        codecs.lookup(name).name: name
        for name in ENCODINGS
        if not name.startswith(("utf-", "mac-"))
    }
    sample = data[:LONGEST_SAMPLE]
    if len(data) > LONGEST_SAMPLE:  # half a character at its end would rule out the right encoding
        sample = sample[: sample.rfind(b"\n") + 1] or sample
    best = from_bytes(sample, cp_isolation=list(names)).best()
    if best is None or "cp1252" in best.could_be_from_charset:
        return "windows-1252"
    return names[codecs.lookup(best.encoding).name]


def read_upload(
    text: str, source: str = "", format: str = "", has_head: bool | None = None
) -> Sheet:
    """Read an upload. ``format`` and ``has_head`` are recognised unless they are given.

    Raises LanguageError for what is something else than utterances, such as a grammar.
    """
    if not format:
        _refuse_other_files(text, source)
    if format in ("", UploadFormat.TAKEN) and (said := take_utterances(text, source)):
        rows = [UploadRow(each.line, {"text": each.text, "form": each.form}) for each in said]
        warning = (
            "Utterances were taken out of the file; its intents and marks of entities are left out."
        )
        return replace(_sheet(UploadFormat.TAKEN, rows), warnings=(warning,))
    chosen = UploadFormat(format) if format else recognise(text)
    match chosen:
        case UploadFormat.TAKEN:
            hint = "choose another format"
            raise LanguageError("this is no such file of another program", Position(source), hint)
        case UploadFormat.JSON:
            return _read_json(text, source)
        case UploadFormat.JSONL:
            return _read_json_lines(text, source)
        case UploadFormat.CSV | UploadFormat.TSV:
            return _read_table(text, source, chosen, has_head)
        case UploadFormat.PAIRS:
            return _read_pairs(text, source)
    lines = enumerate(text.split("\n"), start=1)
    return _sheet(
        UploadFormat.TEXT, [UploadRow(line, {"text": said}) for line, said in lines if said.strip()]
    )


def _refuse_other_files(text: str, source: str) -> None:
    """Raise LanguageError for the files of a generator and other texts that hold no utterances."""
    start = text.lstrip()[:200].lower()
    place = Position(source)
    tag = re.match(r"<([a-z]\w*)[\s>]", start)
    if start.startswith(("<!doctype html", "<html")):
        raise LanguageError("this is a web page", place, "copy its text and paste it")
    if start.startswith(("<?xml", "<!")) or (tag and f"</{tag[1]}" in text[-2_000:].lower()):
        hint = "objects.xml, locations.xml, names.xml … belong on Import and export"
        raise LanguageError("this is XML, not utterances", place, hint)
    if _CROWD_HEAD.match(_without_mark_line(text)):
        hint = "import them under Paraphrases → Campaigns, where rewrites keep their forms"
        raise LanguageError("these are results of a crowd task", place, hint)
    lines = [line for line in text.split("\n")[:500] if line.strip()]
    rules = sum(1 for line in lines if re.match(r"\s*\$\w+\s*=", line))
    templates = sum(
        1 for line in lines if re.search(r"=\s*\(\w", line) and line.rstrip()[-1:] == ")"
    )
    if rules and 2 * rules >= sum(1 for line in lines if line.lstrip()[:1] not in "#;%/"):
        raise LanguageError("this is a grammar", place, "grammars belong on Import and export")
    if templates and 2 * templates >= sum(1 for line in lines if line.lstrip()[:1] != "#"):
        raise LanguageError(
            "these are semantic templates", place, "they belong on Import and export"
        )


def recognise(text: str) -> UploadFormat:
    """Return the format that ``text`` looks like. Pure and linear in its length."""
    start = text.lstrip()
    is_said = re.match(r"\[[^\[\]\"\n]*\][ \t]*\w", start)  # “[10:32] bring me the plum”
    if not is_said and re.match(r"[\[{]\s*([\[{\"\]}]|-?\d|true|false|null|\Z)", start):
        first = start.split("\n", 1)[0].strip()
        rest = start[len(first) :].strip()
        is_line = _end_of_json(first) == len(first)
        return UploadFormat.JSONL if is_line and rest else UploadFormat.JSON
    lines = [line for line in text.split("\n") if line.strip()]
    is_quoted = all(
        line[:1] == '"' and _end_of_json(line.strip()) == len(line.strip()) for line in lines[:20]
    )
    if lines and is_quoted and lines[0].strip('" ').lower() not in TEXT_NAMES:
        return UploadFormat.JSONL
    if _period_of_forms(lines):
        return UploadFormat.PAIRS
    delimiter = delimiter_of(text)
    if delimiter:
        return UploadFormat.TSV if delimiter == "\t" else UploadFormat.CSV
    return UploadFormat.TEXT


def _end_of_json(line: str) -> int:
    """Return where the value of JSON that ``line`` begins with ends; -1 where it begins with none."""
    try:
        return json.JSONDecoder().raw_decode(line)[1]
    except (ValueError, RecursionError):
        return -1


# --- tables ---------------------------------------------------------------------------------------


def delimiter_of(text: str) -> str:
    """Return what separates the columns of a table; empty where ``text`` looks like no table.

    A comma or semicolon with a blank behind it is one of a sentence, unless the first row has the names of
    columns. Commas alone make no table of lines without a head: there are cells in quotation marks too, or a
    column has only numbers, or the first one only names such as ``greet``.
    """
    if declared := _declared_delimiter(text):
        return declared
    sample = _without_mark_line(text)[:LONGEST_SAMPLE]
    for delimiter in ("\t", ";", ",", "|"):
        rows = [row for row in _sample_rows(sample, delimiter) if any(row)]
        widths = [len(row) for row in rows]
        if not rows or widths[0] < 2:
            continue
        if _names_a_text(rows, delimiter):
            return delimiter
        if len(rows) < 2 or min(widths) < 2:
            continue
        most_common = max(set(widths), key=widths.count)
        if widths.count(most_common) < 0.8 * len(widths):
            continue
        is_prose = delimiter in ",;" and any(
            cell[:1] == " " and not cell.strip().isdigit() for row in rows for cell in row[1:]
        )
        if is_prose:
            continue
        is_quoted = re.search(r'(?:^|,)"[^"\n]*"(?:,|$)', sample[:10_000], re.MULTILINE)
        has_labels = all(re.fullmatch(r"[\w.-]+", row[0]) for row in rows)
        if delimiter != "," or is_quoted or has_labels or _has_numbers(rows):
            return delimiter
    first = next((line for line in sample.split("\n") if line.strip()), "")
    is_one_column = first.strip().strip('"').lower() in TEXT_NAMES
    return "," if is_one_column and sample.count("\n") else ""


def _names_a_text(rows: Sequence[Sequence[str]], delimiter: str) -> bool:
    """Whether the first row is a head, one of whose names is that of texts.

    “Message, please read it” is a sentence: where blanks follow the delimiter, the others have to be names too.
    """
    ranked = [_rank(name, TEXT_NAMES) is not None for name in rows[0]]
    if not any(ranked):
        return False
    if delimiter not in ",;" or not any(cell[:1] == " " for cell in rows[0][1:]):
        return True
    other_names = {*TEXT_NAMES, *FORM_NAMES, *_USUAL_NAMES}
    is_named = all(name.strip().lower() in other_names for name in rows[0])
    return is_named or _has_numbers(rows)


def _has_numbers(rows: Sequence[Sequence[str]]) -> bool:
    """Whether a column holds numbers alone, its head left out."""
    below = rows[1:] or rows
    columns = zip(*(row for row in below if len(row) == len(rows[0])), strict=True)
    return any(all(_is_number(cell.strip()) for cell in column) for column in columns)


def _declared_delimiter(text: str) -> str:
    """Return the delimiter of Excel's first line ``sep=;``; empty without one."""
    match = re.match(r"\s*\"?sep=([^\"])\"?[ ]*\n", text, re.IGNORECASE)
    return match[1] if match else ""


def _without_mark_line(text: str) -> str:
    return text.split("\n", 1)[-1] if _declared_delimiter(text) else text


def _sample_rows(sample: str, delimiter: str) -> list[list[str]]:
    rows: list[list[str]] = []
    with suppress(csv.Error):  # the rows before a broken one will do
        rows.extend(islice(csv.reader(io.StringIO(sample, newline=""), delimiter=delimiter), 50))
    return rows


def _read_table(text: str, source: str, format: UploadFormat, has_head: bool | None) -> Sheet:
    delimiter = "\t" if format is UploadFormat.TSV else _declared_delimiter(text)
    delimiter = delimiter or delimiter_of(text) or ","
    skipped = 1 if _declared_delimiter(text) else 0
    rows, problems = _rows_of(_without_mark_line(text), delimiter, source, skipped)
    if not rows:
        return Sheet(format, problems=tuple(problems) or (_nothing(source),))
    head = [normalise_line(cell) for cell in rows[0][1]]
    has_head = _looks_like_head([cells for _, cells in rows]) if has_head is None else has_head
    body = rows[1:] if has_head else rows
    width = len(head) if has_head else max(len(cells) for _, cells in rows)
    names = _names(head if has_head else [], width)
    records: list[UploadRow] = []
    for line, cells in body:
        if width == 1:  # whatever is delimited belongs to the text
            cells = [delimiter.join(cells)]
        if len(cells) > width and any(cell.strip() for cell in cells[width:]):
            hint = f"put a text that has a “{delimiter}” in it in quotation marks"
            message = f"the row has {len(cells)} cells, and the head {width}"
            problems.append(error_at(Position(source, line), message, hint))
            continue
        values = {
            name: _FORMULA_GUARD.sub("", cell[:LONGEST_VALUE])
            for name, cell in zip(names, cells, strict=False)
        }
        given = [value.strip() for value in values.values() if value.strip()]
        if not all(map(_RULER.fullmatch, given)):
            records.append(UploadRow(line, values))
    sheet = _sheet(format, records, names, problems)
    return replace(sheet, has_head=has_head)


def _rows_of(
    text: str, delimiter: str, source: str, skipped: int
) -> tuple[list[tuple[int, list[str]]], list[Problem]]:
    """Return the rows that are not blank, each with the line where it begins, and what is wrong."""
    rows: list[tuple[int, list[str]]] = []
    # Texts of tab-separated tables may hold a single quotation mark; in the others it would swallow rows.
    has_odd_quotes = delimiter == "\t" and text.count('"') % 2
    quoting: Literal[0, 3] = csv.QUOTE_NONE if has_odd_quotes else csv.QUOTE_MINIMAL
    reader = csv.reader(
        io.StringIO(text, newline=""), delimiter=delimiter, quoting=quoting, strict=True
    )
    begins = 1
    try:
        for cells in reader:
            if len(cells) > MOST_COLUMNS:
                place = Position(source, begins + skipped)
                return rows, [error_at(place, f"there are more than {MOST_COLUMNS} columns")]
            if any(cell.strip() for cell in cells):
                rows.append((begins + skipped, cells))
            begins = reader.line_num + 1
    except csv.Error as error:
        hint = "close the quotation mark, or double one that belongs to the text"
        message = "the row has a stray quotation mark"
        reason = error.args[0]
        if "unexpected end" in reason:
            message = "a quotation mark is not closed"
        elif "field limit" in reason:
            message = f"a cell has more than {csv.field_size_limit():,} characters"
        return rows, [error_at(Position(source, begins + skipped), message, hint)]
    return rows, []


def _looks_like_head(rows: Sequence[Sequence[str]]) -> bool:
    """Whether the first row names the columns."""
    first = [cell.strip() for cell in rows[0]]
    if any(
        _rank(name, (*TEXT_NAMES, *FORM_NAMES)) is not None and len(name) < 40 for name in first
    ):
        return True
    for column, name in enumerate(first):
        below = [row[column].strip() for row in rows[1:] if len(row) > column]
        if name and not _is_number(name) and below and all(map(_is_number, below)):
            return True
    return False


def _is_number(text: str) -> bool:
    return bool(re.fullmatch(r"[-+]?\d[\d.,]*", text))


def _names(head: Sequence[str], width: int) -> list[str]:
    names: list[str] = []
    for number in range(width):
        name = (head[number] if number < len(head) else "")[:100] or f"column {number + 1}"
        again = sum(1 for each in names if each == name or each.startswith(f"{name} ("))
        names.append(f"{name} ({again + 1})" if again else name)
    return names


# --- JSON -----------------------------------------------------------------------------------------


def _read_json(text: str, source: str) -> Sheet:
    try:
        value = json.loads(text)
    except json.JSONDecodeError as error:
        place = Position(source, error.lineno, error.colno)
        hint = "JSON Lines have one object a line" if error.msg == "Extra data" else ""
        return Sheet(
            UploadFormat.JSON, problems=(error_at(place, f"this is not JSON: {_why(error)}", hint),)
        )
    except (ValueError, RecursionError):
        return Sheet(UploadFormat.JSON, problems=(error_at(Position(source), TOO_DEEP),))
    if said := join_fragments(value):
        rows = [UploadRow(number, {"text": told}) for number, told in enumerate(said, start=1)]
        return _sheet(UploadFormat.JSON, rows)
    items = _find_items(value)
    if items is None:
        hint = "send a list of texts, or of objects with a text in each"
        return Sheet(
            UploadFormat.JSON,
            problems=(error_at(Position(source), "there is no list in it", hint),),
        )
    return _of_items(UploadFormat.JSON, enumerate(items, start=1), source, [])


def _why(error: json.JSONDecodeError) -> str:
    return f"{error.msg[:1].lower()}{error.msg[1:]}"


def _read_json_lines(text: str, source: str) -> Sheet:
    items: list[tuple[int, Any]] = []
    problems: list[Problem] = []
    for line, written in enumerate(text.split("\n"), start=1):
        if not written.strip():
            continue
        try:
            items.append((line, json.loads(written)))
        except json.JSONDecodeError as error:
            place = Position(source, line, error.colno)
            problems.append(error_at(place, f"this line is not JSON: {_why(error)}"))
        except (ValueError, RecursionError):
            problems.append(error_at(Position(source, line), TOO_DEEP))
    return _of_items(UploadFormat.JSONL, items, source, problems)


def _find_items(value: Any) -> list[Any] | None:
    """Return the list of an export: the value itself, or the first list of objects or texts inside it.

    An object that has a text of its own is the only item, unless the list inside it has objects with texts.
    An empty list counts where there is no other one.
    """
    if isinstance(value, dict) and _has_text(value):
        lists = [each for each in value.values() if isinstance(each, list) and each]
        return next((each for each in lists if all(map(_has_text, each[:20]))), [value])
    inside: list[Any] = [value]
    empty: list[Any] | None = None
    for _ in range(4):  # levels; exports wrap their list in two at most
        for item in inside:
            if isinstance(item, list) and item and isinstance(item[0], dict | str | list):
                return item
            if item == []:
                empty = item
        inside = [below for item in inside if isinstance(item, dict) for below in item.values()]
    if empty is not None:
        return empty
    return [value] if isinstance(value, dict) and value else None


def _has_text(item: Any, levels: int = 3) -> bool:
    """Whether an object has a text under one of the known names, its own or that of an object in it."""
    return isinstance(item, dict) and any(
        _rank(name, TEXT_NAMES) is not None
        if isinstance(each, str)
        else levels > 1 and _has_text(each, levels - 1)
        for name, each in item.items()
    )


def _of_items(
    format: UploadFormat, items: Iterable[tuple[int, Any]], source: str, problems: list[Problem]
) -> Sheet:
    records: list[UploadRow] = []
    items = list(items)
    n_refused = _count_refused(items)
    for line, item in items:
        if n_refused and item["answer"] != "accept":
            continue
        try:
            values, has_half_text = _flat(item), _has_half_text(item)
            if form := form_of_task(item):
                values = {**(values or {}), "logical_form": _storable(form)}
        except RecursionError:  # it was just not too deep for being parsed
            problems.append(error_at(Position(source, line), TOO_DEEP))
            continue
        if values is None:
            what = "this is a number or nothing, not a text or an object"
            problems.append(error_at(Position(source, line), what))
        elif has_half_text:
            what = "a text here has half a character (a lone surrogate)"
            problems.append(error_at(Position(source, line), what, "write the whole character"))
        else:
            records.append(UploadRow(line, values))
    sheet = _sheet(format, records, problems=problems)
    if n_refused:
        warning = f"{n_refused:,} that Prodigy has as rejected or ignored are left out."
        sheet = replace(sheet, warnings=(warning,))
    return sheet


def _count_refused(items: Sequence[tuple[int, Any]]) -> int:
    """Return how many items of Prodigy somebody has rejected or ignored; 0 for other items."""
    answers = [item.get("answer") if isinstance(item, dict) else None for _, item in items]
    is_of_prodigy = all(each in ("accept", "reject", "ignore") for each in answers)
    return sum(each != "accept" for each in answers) if is_of_prodigy else 0


def _has_half_text(item: Any) -> bool:
    """Whether a text anywhere in an item is none that can be stored."""
    match item:
        case str():
            return has_half_character(item)
        case dict():
            return any(map(_has_half_text, item.values()))
        case list():
            return any(map(_has_half_text, item))
    return False


def _flat(item: Any) -> dict[str, str] | None:
    """Return the texts of an item by their names; those of objects inside it as ``data.text``."""
    match item:
        case str():
            return {"text": _storable(item)}
        case dict():
            return dict(_texts_in(item))
        case list():
            return {
                f"column {n}": _as_text(each) for n, each in enumerate(item[:MOST_COLUMNS], start=1)
            }
    return None


def _texts_in(item: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, str]]:
    for name, value in list(item.items())[:MOST_COLUMNS]:
        path = f"{before}{normalise_line(_storable(name)[:100])}"
        if isinstance(value, dict) and before.count(".") < 2:
            yield from _texts_in(value, f"{path}.")
        else:
            yield path, _as_text(value)


def _as_text(value: Any) -> str:
    if isinstance(value, str):
        return _storable(value)
    if value is None or value == [] or value == {}:
        return ""
    if isinstance(value, bool | int | float):
        return str(value) if not isinstance(value, int) or abs(value) < 10**18 else "a long number"
    return _storable(json.dumps(value, ensure_ascii=False)[:200])


def _storable(text: str) -> str:
    """Return a text without half characters, which JSON can write and nothing else can hold."""
    return text[:LONGEST_VALUE].encode("utf-8", "replace").decode()


# --- pairs ----------------------------------------------------------------------------------------


def _period_of_forms(lines: Sequence[str]) -> int:
    """Return after how many lines a form stands again: 2 in a pair file, 3 in triples; 0 where it is none."""
    for period in (2, 3):
        if len(lines) < period:
            continue
        is_form = [line.lstrip()[:1] == "(" and line.rstrip()[-1:] == ")" for line in lines]
        last = [each for n, each in enumerate(is_form) if n % period == period - 1]
        others = [each for n, each in enumerate(is_form) if n % period != period - 1]
        if sum(last) >= 0.9 * len(last) and not any(others):
            return period
    return 0


def _read_pairs(text: str, source: str) -> Sheet:
    lines = [(line, said) for line, said in enumerate(text.split("\n"), start=1) if said.strip()]
    period = _period_of_forms([said for _, said in lines]) or 2
    whole = len(lines) - len(lines) % period
    problems = [
        error_at(Position(source, line), "this line has no form behind it")
        for line, _ in lines[whole:]
    ]
    records = [
        UploadRow(lines[n][0], {"utterance": lines[n][1], "form": lines[n + period - 1][1]})
        for n in range(0, whole, period)
    ]
    warning = (
        "These are pairs of a command and its form. To make a split of them, use Import pairs."
    )
    return replace(_sheet(UploadFormat.PAIRS, records, problems=problems), warnings=(warning,))


# --- columns --------------------------------------------------------------------------------------


def _sheet(
    format: UploadFormat,
    records: Sequence[UploadRow],
    columns: Sequence[str] = (),
    problems: Sequence[Problem] = (),
) -> Sheet:
    """Return the sheet with the column guessed that has the texts, and the one that has forms."""
    names = list(columns) or list(dict.fromkeys(name for row in records for name in row.values))
    if len(names) > MOST_COLUMNS:
        names = names[:MOST_COLUMNS]
    with_text = {name for row in records for name, text in row.values.items() if text.strip()}
    filled = [name for name in names if name in with_text]
    likeness = {name: _likeness(records, name) for name in filled}
    by_name = _best([name for name in filled if likeness[name]], TEXT_NAMES)
    by_name = by_name or _best(filled, TEXT_NAMES) or _best(columns, TEXT_NAMES)
    column = by_name or max(filled, key=likeness.__getitem__, default="")
    return Sheet(
        format,
        tuple(filled),
        tuple(records),
        column,
        bool(by_name) or len(filled) < 2,
        _best([name for name in filled if name != column], FORM_NAMES),
        problems=tuple(problems) if records or problems else (_nothing(""),),
    )


def _nothing(source: str) -> Problem:
    return error_at(Position(source), "there is no utterance in it")


def _best(names: Sequence[str], known: Sequence[str]) -> str:
    ranked = [(_rank(name, known), name) for name in names]
    return min(((rank, name) for rank, name in ranked if rank is not None), default=(0, ""))[1]


def _rank(name: str, known: Sequence[str]) -> tuple[int, int] | None:
    """Return how surely a column has what ``known`` names, lower is surer; None where its name says nothing."""
    plain = normalise_line(name[:200]).lower()
    words = _BETWEEN_WORDS.split(plain)
    last = words[-1].rstrip("0123456789") if len(words) < 3 else ""  # longer ones are sentences
    for n_words, spelled in enumerate((plain, plain.rpartition(".")[2], last)):
        for place, each in enumerate(known):
            if spelled in (each, f"{each}s"):
                return n_words, place
    return None


def _likeness(records: Sequence[UploadRow], name: str) -> float:
    """Return how much a column reads as what people say: many different texts of several words, without markup."""
    texts = [row.values.get(name, "")[:500] for row in records[:200]]
    score = 0.0
    for text in texts:
        letters = sum(each.isalpha() for each in text)
        if not _UNSAID.search(text) and 2 * letters > len(text):
            score += min(letters / _LETTERS_OF_WORD, 2 * len(text.split()), _MOST_WORDS)
    return score * len(set(texts)) / max(len(texts), 1) ** 2
