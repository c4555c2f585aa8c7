"""Verb: export a split, row by row: pair files (docs/reference/formats.md, Pairs), JSON Lines, CSV, Parquet,
a data set of Hugging Face."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path

from django.db import models
from django.db.models import Count, QuerySet

from annotations.exchange.dataset_card import write_card
from annotations.exchange.pipe import Pipe
from annotations.exchange.split_manifest import manifest_of
from annotations.exchange.tables import CHUNK, table_pieces, text_pieces
from annotations.language.corpus import CORPUS_FOLDERS, PART_FILES, Criterion, Part, write_pairs
from annotations.language.texts import Refusal
from annotations.models import Example, Split

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
TYPES = {"position": "int32"}
MANIFEST = "manifest.json"


class SplitFormat(models.TextChoices):
    """``zip`` holds the pair files of all parts with the manifest, as an import of pairs takes them; ``datasets`` a
    Parquet file a part with a card, as ``datasets.load_dataset`` does."""

    TXT = "txt"
    JSONL = "jsonl"
    CSV = "csv"
    PARQUET = "parquet"
    ZIP = "zip"
    DATASETS = "datasets"


def export_pieces(
    split: Split, as_: str, part: str | None = None, source: str | None = None
) -> Iterator[bytes]:
    """Return the chosen examples of ``split`` as a file in pieces, none of them large.

    ``as_`` is a ``SplitFormat``. Raises Refusal for ``txt`` without ``part`` and ``source``.
    """
    rows = _chosen(split, part, source).values_list(*FIELDS).iterator(chunk_size=CHUNK)
    match SplitFormat(as_):
        case SplitFormat.TXT:
            return text_pieces(pair_lines(split, part, source))
        case SplitFormat.ZIP:
            return _archive(_pair_files(split, part, source))
        case SplitFormat.DATASETS:
            return _archive(_dataset_files(split, part, source))
        case SplitFormat.PARQUET:
            return table_pieces(rows, FIELDS, as_, TYPES, manifest_of(split, part, source))
    return table_pieces(rows, FIELDS, as_)


def pair_lines(split: Split, part: str | None, source: str | None) -> Iterator[str]:
    """Return one part of one source as the lines of a pair file, each with its line end.

    Of an imported split it is the file that came in, byte for byte. Raises Refusal without ``part`` and ``source``.
    """
    if not (part and source):
        raise Refusal(
            "A pair file holds one part of one source: say which part and source.",
            "part_and_source_needed",
        )
    columns = ("utterance", "written_form", "logical_form")
    pairs = _chosen(split, part, source).values_list(*columns).iterator(chunk_size=CHUNK)
    return write_pairs((utterance, written or form) for utterance, written, form in pairs)


def export_split(split: Split, as_: str, target: Path) -> dict[str, int]:
    """Write a whole split; return the number of examples by path.

    ``txt`` makes a folder of pair files, laid out as ``import_pairs`` reads it (``gen_logical/val.txt``),
    ``datasets`` one for ``load_dataset``; the other formats make the file ``target``. Raises OSError where that
    cannot be written.
    """
    counts = _count_files(split)
    if as_ == SplitFormat.DATASETS:
        for name, pieces in _dataset_files(split):
            _write(target / name, pieces)
        return {
            str(target / _dataset_path(part)): sum(n for _, of, n in counts if of == part)
            for part in dict.fromkeys(part for _, part, _ in counts)
        }
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
    rows = _chosen(split, part, source).order_by()
    return sorted(rows.values_list("source", "part").annotate(n=Count("pk")))


def _write(path: Path, pieces: Iterable[bytes]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        file.writelines(pieces)


def _chosen(split: Split, part: str | None, source: str | None) -> QuerySet[Example]:
    """Return the chosen examples in the order of the files."""
    chosen = {name: value for name, value in (("part", part), ("source", source)) if value}
    return split.examples.filter(**chosen)


# A file of an archive or a folder: its path, and its content in pieces.
_File = tuple[str, Iterable[bytes]]


def _pair_files(split: Split, part: str | None, source: str | None) -> Iterator[_File]:
    """Yield a pair file for each part of each source, and the manifest."""
    for of, where, _ in _count_files(split, part, source):
        path = f"{folder_of(split, of)}/{PART_FILES[where]}"
        yield path, export_pieces(split, SplitFormat.TXT, where, of)
    manifest = json.dumps(manifest_of(split, part, source), ensure_ascii=False, indent=2)
    yield MANIFEST, [f"{manifest}\n".encode()]


def _dataset_files(
    split: Split, part: str | None = None, source: str | None = None
) -> Iterator[_File]:
    """Yield the card of a data set, and a table for each part that is not empty."""
    counted = {where for _, where, _ in _count_files(split, part, source)}
    parts = {str(each): _dataset_path(each) for each in Part if each in counted}
    yield "README.md", [write_card(manifest_of(split, part, source), parts).encode()]
    for where, path in parts.items():
        yield path, export_pieces(split, SplitFormat.PARQUET, where, source)


def _dataset_path(part: str) -> str:
    return f"data/{part}.parquet"


def _archive(files: Iterable[_File]) -> Iterator[bytes]:
    target = Pipe()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, pieces in files:
            with archive.open(path, "w", force_zip64=True) as file:
                for piece in pieces:
                    file.write(piece)
                    yield target.take()
    yield target.take()
