"""Verb: export utterances with their labels, row by row: as tables, and as other programs take them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from django.db.models import Prefetch, QuerySet

from annotations.exchange.tables import TableFormat, table_pieces
from annotations.labelling.label_formats import LABEL_FILES
from annotations.models import Label, Utterance, World

CHUNK = 1_000  # rows fetched at once

# The keys of every export, in this order in every release. The last three are of the answer that decides.
FIELDS = (
    *("id", "text", "anonymized_text", "spans", "status", "logical_form", "origin", "file_name"),
    *("created_by", "created_at", "version", "labels", "annotator", "labelled_at", "seconds"),
)
TYPES = {"id": "int64", "version": "int64", "seconds": "double"}


def export_labels(world: World, rows: QuerySet[Utterance], as_: str) -> Iterator[bytes]:
    """Return the utterances ``rows`` of ``world`` as a file in pieces, none of them large.

    ``as_`` is a ``TableFormat`` or a ``LabelFormat``. ``labels`` are the answers that were accepted and not taken
    back, the one that decides last: what waits to be compared with another person's answer is in no export.
    In tables ``spans`` and ``labels`` are JSON.
    """
    if as_ in LABEL_FILES:
        classes = world.entity_classes.values_list("token", flat=True)
        return LABEL_FILES[as_].write(rows.iterator(chunk_size=CHUNK), list(classes))
    answers = Label.objects.accepted().select_related("annotator").order_by("accepted_at", "id")
    chosen = rows.select_related("created_by", "upload").defer("upload__content")
    with_answers = chosen.prefetch_related(Prefetch("labels", answers, to_attr="answers"))
    values = (_values(row) for row in with_answers.iterator(chunk_size=CHUNK))
    if as_ != TableFormat.JSONL:
        values = (
            [
                json.dumps(each, ensure_ascii=False) if isinstance(each, list) else each
                for each in row
            ]
            for row in values
        )
    manifest = {"format": "gpsr-workbench-labels", "version": 1, "world": world.name}
    return table_pieces(values, FIELDS, as_, TYPES, manifest)


def _values(row: Any) -> list[Any]:
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
    return [
        *(getattr(row, name) for name in FIELDS[:7]),
        row.upload.file_name if row.upload else "",
        _name(row.created_by),
        row.created_at.isoformat(),
        row.version,
        labels,
        *(decisive.get("annotator", ""), decisive.get("at", ""), decisive.get("seconds")),
    ]


def _name(person: Any) -> str:
    return person.username if person else ""
