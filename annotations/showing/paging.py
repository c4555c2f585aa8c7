"""Cut a long list into pages by keyset: a page costs the same however far it is from the start."""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass
from typing import Any

from django.core.exceptions import FieldDoesNotExist, ValidationError
from django.db.models import Model, Q, QuerySet

PAGE_SIZE = 50
LARGEST_INTEGER = 2**63 - 1  # of a column and of a query's parameter
LONE_SURROGATE = re.compile(r"[\ud800-\udfff]")


def number_in(text: str) -> int:
    """Read a key or a version from a URL or a form. Return 0, which no row has, for anything else."""
    return int(text) if text.isascii() and text.isdigit() and len(text) < 19 else 0


def opposite(order: str) -> str:
    """Return the other direction of an order such as ``-name``."""
    return order[1:] if order.startswith("-") else f"-{order}"


@dataclass(frozen=True, slots=True)
class Page:
    """Rows in order, and the cursors of the previous and next page (empty where there is none)."""

    rows: list[Any]
    before: str
    after: str


def page_of(
    rows: QuerySet[Any], order: str, after: str = "", before: str = "", size: int = PAGE_SIZE
) -> Page:
    """Return the page of ``rows`` that follows cursor ``after``, or precedes ``before``, or the first.

    ``order`` names a field that is never null, with ``-`` for descending; ties are ordered by the
    primary key. A cursor that cannot be read is ignored.
    """
    backwards = bool(before)
    cursor = read_cursor(rows.model, order, before or after)
    descending = order.startswith("-") != backwards
    field = order.lstrip("-")
    if cursor:
        step, (value, key) = "lt" if descending else "gt", cursor
        rows = rows.filter(
            Q(**{f"{field}__{step}": value}) | Q(**{field: value, f"pk__{step}": key})
        )
    sign = "-" if descending else ""
    shown = list(rows.order_by(f"{sign}{field}", f"{sign}pk")[: size + 1])
    more, shown = len(shown) > size, shown[:size]
    if backwards:
        shown.reverse()
    has_previous = more if backwards and cursor else bool(cursor)
    has_next = bool(cursor) if backwards and cursor else more
    return Page(
        rows=shown,
        before=write_cursor(shown[0], field) if shown and has_previous else "",
        after=write_cursor(shown[-1], field) if shown and has_next else "",
    )


def write_cursor(row: Model, field: str) -> str:
    """Write down where ``row`` stands in the order of ``field`` (which may reach through relations)."""
    value: Any = row
    for name in field.split("__"):
        value = getattr(value, name)
    return json.dumps([value, row.pk], default=str)


def read_cursor(model: type[Model], order: str, text: str) -> tuple[Any, int] | None:
    """Read what ``write_cursor`` wrote: the value as ``order``'s field holds it, and the key.

    Returns None where the text is no cursor. A name without a field is a count made by the query, so
    its value is a whole number.
    """
    try:
        value, key = json.loads(text)
        cursor = to_python(model, order.lstrip("-"), value), int(key)
    except (ValueError, TypeError, ValidationError, OverflowError, RecursionError):
        return None
    return cursor if all(map(_can_be_compared, cursor)) else None


def _can_be_compared(value: Any) -> bool:
    """Return whether the database can compare a column with ``value``, which comes from a URL."""
    if isinstance(value, int):
        return abs(value) <= LARGEST_INTEGER
    if isinstance(value, float):
        return math.isfinite(value)
    if isinstance(value, str):
        return "\0" not in value and not LONE_SURROGATE.search(value)
    return value is not None


def to_python(model: type[Model], path: str, value: Any) -> Any:
    """Convert ``value`` to the type of the field at the end of ``path``."""
    try:
        return field_of(model, path).to_python(value)
    except FieldDoesNotExist:
        return int(value)


def field_of(model: type[Model], path: str) -> Any:
    """Return the field at the end of a path such as ``example__position``."""
    first, _, rest = path.partition("__")
    field: Any = model._meta.get_field(first)
    return field_of(field.related_model, rest) if rest else field
