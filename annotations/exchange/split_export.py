"""Verb: export a split, row by row: pair files (docs/reference/formats.md, Pairs), JSON Lines, CSV, Parquet."""

from __future__ import annotations

import csv
import json
import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from django.db import models
from django.db.models import Count

from annotations.exchange.parquet_export import parquet_pieces
from annotations.exchange.pipe import Pipe
from annotations.exchange.split_manifest import manifest_of
from annotations.language.corpus import CORPUS_FOLDERS, PART_FILES, Criterion, write_pairs
from annotations.language.texts import Refusal
from annotations.models import Split
from annotations.rows.synchronise import batches

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
CHUNK = 2000  # rows fetched, and sent, at once
MANIFEST = "manifest.json"

# A spreadsheet takes a cell that begins so for a formula.
FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")
Row = tuple[Any, ...]


class SplitFormat(models.TextChoices):
    """``zip`` holds the pair files of all parts with the manifest, as an import of pairs takes them."""

    TXT = "txt"
    JSONL = "jsonl"
    CSV = "csv"
    PARQUET = "parquet"
    ZIP = "zip"


def export_pieces(
    split: Split, as_: str, part: str | None = None, source: str | None = None
) -> Iterator[bytes]:
    """Return the chosen examples of ``split`` as a file in pieces, none of them large.

    ``as_`` is a ``SplitFormat``. Raises Refusal for ``txt`` without ``part`` and ``source``.
    """
    match SplitFormat(as_):
        case SplitFormat.PARQUET:
            rows = _rows(split, part, source)
            return parquet_pieces(rows, FIELDS, manifest_of(split, part, source))
        case SplitFormat.ZIP:
            return _pair_archive(split, part, source)
    lines = export_lines(split, as_, part, source)
    return ("".join(some).encode() for some in batches(lines, CHUNK))


def export_lines(
    split: Split, as_: str, part: str | None = None, source: str | None = None
) -> Iterator[str]:
    """Return the chosen examples of ``split`` as lines of text, each with its line end.

    ``as_`` is a ``SplitFormat`` of text. ``txt`` is one pair file, so it needs ``part`` and ``source``; of an
    imported split it is the file that came in, byte for byte. Raises Refusal without them.
    """
    if as_ == SplitFormat.TXT and not (part and source):
        raise Refusal(
            "A pair file holds one part of one source: say which part and source.",
            "part_and_source_needed",
        )
    match SplitFormat(as_):
        case SplitFormat.TXT:
            pairs = _rows(split, part, source, ("utterance", "written_form", "logical_form"))
            return write_pairs((utterance, written or form) for utterance, written, form in pairs)
        case SplitFormat.CSV:
            return csv_lines(FIELDS, _rows(split, part, source))
    encode = json.JSONEncoder(ensure_ascii=False).encode
    rows = _rows(split, part, source)
    return (encode(dict(zip(FIELDS, row, strict=True))) + "\n" for row in rows)


def export_split(split: Split, as_: str, target: Path) -> dict[str, int]:
    """Write a whole split; return the number of examples by path.

    ``txt`` makes a folder of pair files, laid out as ``import_pairs`` reads it (``gen_logical/val.txt``);
    the other formats make the file ``target``. Raises OSError where that cannot be written.
    """
    counts = _count_files(split)
    if as_ != SplitFormat.TXT:
        _write(target, export_pieces(split, as_))
        return {str(target): sum(count for _, _, count in counts)}
    files: dict[str, int] = {}
    for source, part, count in counts:
        path = target / folder_of(split, source) / PART_FILES[part]
        _write(path, export_pieces(split, as_, part, source))
        files[str(path)] = count
    return files


def folder_of(split: Split, source: str) -> str:
    """Return ``gen``, ``para_logical``, …: the folder of a source, by the criterion of the split."""
    kinds = {kind: folder for folder, kind in CORPUS_FOLDERS.items()}
    plain = kinds[source, Criterion.COMMAND]
    return kinds.get((source, split.criterion), f"{plain}_{split.criterion}")


def _count_files(
    split: Split, part: str | None = None, source: str | None = None
) -> list[tuple[str, str, int]]:
    """Return source, part and number of examples of each pair file that is not empty, in order."""
    chosen = {name: value for name, value in (("part", part), ("source", source)) if value}
    rows = split.examples.filter(**chosen).order_by()
    return sorted(rows.values_list("source", "part").annotate(n=Count("pk")))


def _write(path: Path, pieces: Iterable[bytes]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        file.writelines(pieces)


def _rows(
    split: Split, part: str | None, source: str | None, fields: Iterable[str] = FIELDS
) -> Iterator[Row]:
    """Return the chosen examples in the order of the files."""
    chosen = {name: value for name, value in (("part", part), ("source", source)) if value}
    return split.examples.filter(**chosen).values_list(*fields).iterator(chunk_size=CHUNK)


class _Line:
    """A file that keeps the one line written to it; ``csv`` writes to nothing less than a file."""

    def write(self, text: str) -> None:
        self.text = text


def csv_lines(fields: Iterable[str], rows: Iterable[Iterable[Any]]) -> Iterator[str]:
    """Yield a table with a head as lines of CSV; no cell is a formula for a spreadsheet."""
    line = _Line()
    writer = csv.writer(line)
    writer.writerow(fields)
    yield line.text
    for row in rows:
        writer.writerow([formula_safe(cell) for cell in row])
        yield line.text


def formula_safe(cell: Any) -> Any:
    """Return ``cell`` with an apostrophe before anything that a spreadsheet would execute."""
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(FORMULA_STARTS) else cell


def _pair_archive(split: Split, part: str | None, source: str | None) -> Iterator[bytes]:
    """Yield a zip archive with a pair file for each part of each source, and the manifest."""
    target = Pipe()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for of, where, _ in _count_files(split, part, source):
            path = f"{folder_of(split, of)}/{PART_FILES[where]}"
            with archive.open(path, "w", force_zip64=True) as file:
                for piece in export_pieces(split, SplitFormat.TXT, where, of):
                    file.write(piece)
                    yield target.take()
        manifest = json.dumps(manifest_of(split, part, source), ensure_ascii=False, indent=2)
        archive.writestr(MANIFEST, f"{manifest}\n")
    yield target.take()
