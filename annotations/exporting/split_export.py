"""Verb: give a split out, as pair files (FORMATS §5), JSON Lines or CSV, row by row."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from django.db import models
from django.db.models import Count

from annotations.language.corpus import CORPUS_FOLDERS, PART_FILES, write_pairs
from annotations.models import Split
from annotations.models.splits import Criterion

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
    """Return the chosen examples of ``split`` as lines of text, each with its line end.

    ``as_`` is a ``Format``. ``txt`` is one pair file, so it needs ``part`` and ``source``; of an
    imported split it is the file that came in, byte for byte. Raises ValueError without them.
    """
    if as_ == Format.TXT and not (part and source):
        raise ValueError("A pair file holds one part of one source: say which part and source.")
    chosen = {"part": part, "source": source}
    examples = split.examples.filter(**{key: value for key, value in chosen.items() if value})
    rows = examples.values(*FIELDS, "written_form").iterator(chunk_size=CHUNK)
    return WRITERS[Format(as_)](rows)


def export_split(split: Split, as_: str, target: Path) -> dict[str, int]:
    """Write a whole split; return the number of examples by path.

    ``txt`` makes a folder of pair files, laid out as ``import_pairs`` reads it (``gen_logical/val.txt``);
    the other formats make the file ``target``. Raises OSError where that cannot be written.
    """
    counts = split.examples.order_by().values_list("source", "part").annotate(n=Count("pk"))
    if as_ != Format.TXT:
        _write(target, export_lines(split, as_))
        return {str(target): sum(count for _, _, count in counts)}
    files: dict[str, int] = {}
    for source, part, count in sorted(counts):
        path = target / folder_of(split, source) / PART_FILES[part]
        _write(path, export_lines(split, as_, part, source))
        files[str(path)] = count
    return files


def folder_of(split: Split, source: str) -> str:
    """Return ``gen``, ``para_logical``, …: the folder of a source, by the criterion of the split."""
    kinds = {kind: folder for folder, kind in CORPUS_FOLDERS.items()}
    plain = kinds[source, Criterion.COMMAND]
    return kinds.get((source, split.criterion), f"{plain}_{split.criterion}")


def _write(path: Path, lines: Iterator[str]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        file.writelines(lines)


def _pair_lines(rows: Iterator[dict[str, Any]]) -> Iterator[str]:
    return write_pairs(
        (row["utterance"], row["written_form"] or row["logical_form"]) for row in rows
    )


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
        writer.writerow([formula_safe(row[key]) for key in FIELDS])
        yield line.text


def formula_safe(cell: Any) -> Any:
    """Return ``cell`` with an apostrophe before anything that a spreadsheet would execute."""
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(FORMULA_STARTS) else cell


WRITERS = {Format.TXT: _pair_lines, Format.JSONL: _json_lines, Format.CSV: _csv_lines}
