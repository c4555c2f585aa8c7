"""Verb: give a split out, as pair files (FORMATS §5), JSON Lines or CSV, row by row."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from typing import Any

from django.db import models

from annotations.models import Split

# The keys of every export, in this order in every release.
FIELDS = [
    "position",
    "part",
    "source",
    "utterance",
    "source_command",
    "task_category",
    "logical_form",
    "grounded_form",
]
CHUNK = 2000  # rows fetched at once

# A spreadsheet takes a cell that begins so for a formula.
FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")


class Format(models.TextChoices):
    TXT = "txt"
    JSONL = "jsonl"
    CSV = "csv"


def export_lines(
    split: Split, as_: str, part: str | None = None, source: str | None = None
) -> Iterator[str]:
    """The chosen examples of ``split`` as lines of text, each with its line end.

    ``as_`` is a ``Format``. ``txt`` is one pair file, so it needs ``part`` and ``source``; of an
    imported split it is the file that came in, byte for byte. Raises ValueError without them.
    """
    if as_ == Format.TXT and not (part and source):
        raise ValueError("A pair file holds one part of one source: say which part and source.")
    chosen = {"part": part, "source": source}
    examples = split.examples.filter(**{key: value for key, value in chosen.items() if value})
    rows = examples.values(*FIELDS, "written_form").iterator(chunk_size=CHUNK)
    return WRITERS[Format(as_)](rows)


def _pair_lines(rows: Iterator[dict[str, Any]]) -> Iterator[str]:
    for row in rows:
        yield f"{row['utterance']}\n{row['written_form'] or row['logical_form']}\n"


def _json_lines(rows: Iterator[dict[str, Any]]) -> Iterator[str]:
    for row in rows:
        yield json.dumps({key: row[key] for key in FIELDS}, ensure_ascii=False) + "\n"


class _Line:
    """A file that keeps the one line written to it; ``csv`` writes to nothing less than a file."""

    def write(self, text: str) -> None:
        self.text = text


def _csv_lines(rows: Iterator[dict[str, Any]]) -> Iterator[str]:
    line = _Line()
    writer = csv.writer(line)
    writer.writerow(FIELDS)
    yield line.text
    for row in rows:
        writer.writerow([_formula_safe(row[key]) for key in FIELDS])
        yield line.text


def _formula_safe(cell: Any) -> Any:
    """``cell`` with an apostrophe before anything that a spreadsheet would execute."""
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(FORMULA_STARTS) else cell


WRITERS = {Format.TXT: _pair_lines, Format.JSONL: _json_lines, Format.CSV: _csv_lines}
