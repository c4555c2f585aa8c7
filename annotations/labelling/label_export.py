"""Verb: export utterances with their labels, row by row: JSON Lines, CSV, Parquet."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from enum import StrEnum
from typing import Any

from django.db.models import Prefetch, QuerySet

from annotations.exchange.parquet_export import parquet_pieces
from annotations.exchange.split_export import csv_lines
from annotations.models import Label, Utterance, World
from annotations.rows.synchronise import batches

CHUNK = 1_000  # rows fetched, and sent, at once

# The keys of every export, in this order in every release. The last three are of the answer that decides.
FIELDS = (
    *("id", "text", "anonymized_text", "spans", "status", "logical_form", "origin", "file_name"),
    *("created_by", "created_at", "version", "labels", "annotator", "labelled_at", "seconds"),
)


class LabelFormat(StrEnum):
    JSONL = "jsonl"
    CSV = "csv"
    PARQUET = "parquet"


def export_labels(world: World, rows: QuerySet[Utterance], as_: str) -> Iterator[bytes]:
    """Return the utterances ``rows`` of ``world`` as a file in pieces, none of them large.

    ``as_`` is a ``LabelFormat``. ``labels`` are the answers that were accepted and not taken back, the one
    that decides last: what waits to be compared with another person's answer is in no export. In tables
    ``spans`` and ``labels`` are JSON.
    """
    answers = Label.objects.accepted().select_related("annotator").order_by("accepted_at", "id")
    chosen = rows.select_related("created_by", "upload").defer("upload__content")
    with_answers = chosen.prefetch_related(Prefetch("labels", answers, to_attr="answers"))
    values = (_values(row) for row in with_answers.iterator(chunk_size=CHUNK))
    match LabelFormat(as_):
        case LabelFormat.PARQUET:
            manifest = {"format": "gpsr-workbench-labels", "version": 1, "world": world.name}
            return parquet_pieces((_cells(row) for row in values), FIELDS, manifest)
        case LabelFormat.CSV:
            return _encode(csv_lines(FIELDS, (_cells(row) for row in values)))
    return _encode(f"{json.dumps(row, ensure_ascii=False)}\n" for row in values)


def _values(row: Any) -> dict[str, Any]:
    labels = [
        {
            "annotator": _name(label.annotator),
            "verdict": label.verdict,
            "form": label.form,
            "reason": label.reason,
            "at": label.created_at.isoformat(),
            "seconds": label.seconds,
        }
        for label in row.answers
    ]
    decisive = labels[-1] if labels else {}
    return {
        **{name: getattr(row, name) for name in FIELDS[:7]},
        "file_name": row.upload.file_name if row.upload else "",
        "created_by": _name(row.created_by),
        "created_at": row.created_at.isoformat(),
        "version": row.version,
        "labels": labels,
        "annotator": decisive.get("annotator", ""),
        "labelled_at": decisive.get("at", ""),
        "seconds": decisive.get("seconds"),
    }


def _name(person: Any) -> str:
    return person.username if person else ""


def _cells(row: dict[str, Any]) -> Sequence[Any]:
    """Return a row of a table; ``id`` and ``version`` stay numbers."""
    return [
        json.dumps(value, ensure_ascii=False)
        if isinstance(value, list)
        else value
        if name in ("id", "version")
        else ("" if value is None else str(value))
        for name, value in row.items()
    ]


def _encode(lines: Iterable[str]) -> Iterator[bytes]:
    return ("".join(some).encode() for some in batches(lines, CHUNK))
