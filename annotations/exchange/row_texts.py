"""Normalise the texts of a row, and what follows from them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.core.exceptions import ValidationError
from django.db import models
from django.db.models.lookups import Exact

from annotations.exchange.archive_tables import ArchiveTable
from annotations.language.corpus import distance
from annotations.language.texts import Refusal, TextChanges, normalise_json, normalise_record


def normalise_columns(
    table: ArchiveTable, written: Mapping[str, Any]
) -> tuple[dict[str, Any], TextChanges]:
    """Return the columns of a row of ``table`` with their texts normalised, and what that changed.

    Spans stay at their words, and a paraphrase is measured again.

    Raises:
        Refusal: nothing shows in a text that has to be there, or two names in an object are the same.
    """
    read, changes = normalise_json(dict(written))
    if read == written:
        return read, changes
    if "spans" in written:
        read["spans"] = _move_spans(read["spans"], written["text"])
    if "edit_distance" in written:
        apart = distance(read["utterance"], read["prompt"])
        read |= {"edit_distance": apart.edit, "jaccard_distance": apart.jaccard}
    for column in table.columns:
        was, now = written.get(column.name), read.get(column.name)
        is_changed = isinstance(now, str) and was != now
        if is_changed and not (column.blank or now.strip()):
            raise Refusal(f"nothing shows in {column.name}", "nothing_shows")
    return read, changes


def equal_row(row: models.Model) -> models.Model | None:
    """Return a stored row that a unique constraint does not allow beside ``row``; None where there is none."""
    for unique in row._meta.constraints:
        if not isinstance(unique, models.UniqueConstraint):
            continue
        try:
            unique.validate(type(row), row)
        except ValidationError:
            stored = type(row)._default_manager.filter(unique.condition or models.Q())
            others = stored.exclude(pk=row.pk)
            if unique.fields:
                return others.get(**{name: getattr(row, name) for name in unique.fields})
            values = {
                models.F(field.name): models.Value(getattr(row, field.attname), field)
                for field in row._meta.concrete_fields
            }
            alike = (
                Exact(each, each.replace_expressions(values))  # type: ignore[union-attr, arg-type]  # the stubs do not know that F has it
                for each in unique.expressions
            )
            return others.get(*alike)
    return None


def _move_spans(spans: list[list[Any]], written: str) -> list[list[Any]]:
    """Return the spans of a text that was ``written`` so, where they are now that it is normalised."""
    places = {0: 0}
    begin = length = 0
    for end in sorted({each for span in spans for each in span[:2] if 0 <= each <= len(written)}):
        length += len(normalise_record(written[begin:end]))
        places[end], begin = length, end
    return [[*(places.get(each, each) for each in span[:2]), *span[2:]] for span in spans]
