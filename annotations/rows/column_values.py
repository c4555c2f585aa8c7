"""The value of a column as JSON holds it, and back: as the field's own text where JSON has no such type."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from django.core.exceptions import ValidationError
from django.db.models import Field, JSONField

IN_JSON = (str, bool, int, float, type(None))


def as_json(field: Field[Any, Any], value: Any) -> Any:
    """Return what ``json.dumps`` writes for a ``value`` of the column; ``from_json`` reads it again."""
    if isinstance(value, IN_JSON) or isinstance(field, JSONField):
        return value
    return field.value_to_string(SimpleNamespace(**{field.attname: value}))  # type: ignore[arg-type]  # it reads one attribute


def from_json(field: Field[Any, Any], value: Any) -> Any:
    """Return the value that ``as_json`` has written.

    Raises:
        ValidationError: the column holds no such value.
    """
    if value is None or isinstance(field, JSONField):
        return value
    try:
        return field.to_python(value)
    except (ValueError, TypeError, OverflowError) as error:
        raise ValidationError(str(error)) from error


def can_be_json(field: Field[Any, Any]) -> bool:
    """Return whether ``from_json`` reads what ``as_json`` writes: the field reads its own text, or is of JSON."""
    if isinstance(field, JSONField):
        return field.encoder is None and field.decoder is None
    return type(field).to_python is not Field.to_python
