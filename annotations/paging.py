"""Pages of a long list by keyset: the cost of a page does not grow with its distance from the start."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from django.core.exceptions import FieldDoesNotExist, ValidationError
from django.db.models import Model, Q, QuerySet

PAGE_SIZE = 50


@dataclass(frozen=True, slots=True)
class Page:
    """Some rows in order, and the cursors of the pages beside them (empty where there is none)."""

    rows: list[Any]
    before: str
    after: str


def page_of(
    rows: QuerySet[Any], order: str, after: str = "", before: str = "", size: int = PAGE_SIZE
) -> Page:
    """The page of ``rows`` that follows cursor ``after``, or precedes ``before``, or the first.

    ``order`` names a field that is never null, with ``-`` for descending; ties follow the key.
    A cursor that does not read is taken as none.
    """
    backwards = bool(before)
    cursor = read_cursor(rows.model, order, before or after)
    descending = order.startswith("-") != backwards
    field = order.lstrip("-")
    chosen = rows.filter(_beyond(field, cursor, descending)) if cursor else rows
    sign = "-" if descending else ""
    found = list(chosen.order_by(f"{sign}{field}", f"{sign}pk")[: size + 1])
    more, found = len(found) > size, found[:size]
    if backwards:
        found.reverse()
    has_previous = more if backwards and cursor else bool(cursor)
    has_next = bool(cursor) if backwards and cursor else more
    return Page(
        rows=found,
        before=write_cursor(found[0], field) if found and has_previous else "",
        after=write_cursor(found[-1], field) if found and has_next else "",
    )


def write_cursor(row: Model, field: str) -> str:
    """The place of ``row`` in the order of ``field`` (which may reach through relations)."""
    value: Any = row
    for name in field.split("__"):
        value = getattr(value, name)
    return json.dumps([value, row.pk], default=str)


def read_cursor(model: type[Model], order: str, text: str) -> tuple[Any, int] | None:
    """What ``write_cursor`` wrote, with the value as ``order``'s field has it; None where it does not
    read. What no field stands behind was counted by the query, so it is a whole number."""
    try:
        value, key = json.loads(text)
        return to_python(model, order.lstrip("-"), value), int(key)
    except (ValueError, TypeError, ValidationError):
        return None


def to_python(model: type[Model], path: str, value: Any) -> Any:
    """``value`` as the field at the end of ``path`` has it."""
    try:
        return field_of(model, path).to_python(value)
    except FieldDoesNotExist:
        return int(value)


def field_of(model: type[Model], path: str) -> Any:
    """The field at the end of a path such as ``example__position``."""
    first, _, rest = path.partition("__")
    found = model._meta.get_field(first)
    return field_of(found.related_model, rest) if rest else found


def _beyond(field: str, cursor: tuple[Any, int], descending: bool) -> Q:
    value, key = cursor
    step = "lt" if descending else "gt"
    return Q(**{f"{field}__{step}": value}) | Q(**{field: value, f"pk__{step}": key})
