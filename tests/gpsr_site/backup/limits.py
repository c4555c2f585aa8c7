"""Values at the limit of a column, and beyond it."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

from django.db import models
from django.db.backends.base.operations import BaseDatabaseOperations

RANGES = BaseDatabaseOperations.integer_field_ranges
WIDE = "é"  # two bytes: limits count characters


def at_the_limit(field: models.Field) -> Any:
    """Return the largest value that a column takes; None where another column depends on it, or it has none."""
    if field.primary_key or field.is_relation or field.unique:
        return WIDE * field.max_length if field.name == "username" else None
    match field:
        case models.CharField():
            return WIDE * field.max_length
        case models.JSONField():
            return [{"é": ["\\u0000", "\u2028", 1e-300, 9.5e15, 2**63 - 1, True, None, "🤖"]}]
        case models.TextField():
            return WIDE * 100_000
        case models.BooleanField():
            return None
        case models.IntegerField():
            return RANGES[field.get_internal_type()][1]
        case models.FloatField():
            return 1.7976931348623157e308
        case models.DateTimeField():
            return datetime(9999, 12, 30, 23, 59, 59, 999_999, UTC)
    return None


def beyond_the_limit(field: models.Field) -> list[Any]:
    """Return values that a column may not hold."""
    match field:
        case models.JSONField():
            return [["\0"], [float("nan")], [float("inf")]]
        case models.CharField():
            return [WIDE * (field.max_length + 1), "a\0b", "\ud83d"]
        case models.TextField():
            return ["a\0b", "\ud83d"]
        case models.BooleanField():
            return []
        case models.IntegerField():
            least, most = RANGES[field.get_internal_type()]
            return [least - 1, most + 1, 10**30]
    return []
