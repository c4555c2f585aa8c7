"""Values at the limit of a column, and beyond it; and two rows of every model, each column filled."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, date, datetime, time, timedelta
from decimal import Decimal
from typing import Any
from uuid import UUID

from django.db import connection, models, transaction
from django.db.backends.base.operations import BaseDatabaseOperations

from gpsr_site.backup.backup_tables import BackupTable, tables

RANGES = BaseDatabaseOperations.integer_field_ranges
WIDE = "é"  # two bytes: limits count characters
JSON = [{"é": ["\\u0000", "\u2028", 1e-300, 9.5e15, 2**63 - 1, True, None, "🤖"]}]
LATEST = datetime(9999, 12, 30, 23, 59, 59, 999_999, UTC)
# What a constraint asks of columns together.
TOGETHER: Mapping[str, Mapping[str, Any]] = {"annotations.invitation": {"joined": 1, "places": 2}}


def at_the_limit(field: models.Field) -> Any:
    """Return the largest value that a column takes. A type that is not here fails the test: give it a value."""
    match field:
        case models.JSONField():
            return JSON
        case models.UUIDField():
            return UUID(int=2**128 - 1)
        case models.CharField():
            return WIDE * field.max_length
        case models.TextField():
            return WIDE * 100_000
        case models.BooleanField():
            return True
        case models.IntegerField():
            return RANGES[field.get_internal_type()][1]
        case models.FloatField():
            return 1.7976931348623157e308
        case models.DecimalField():
            return Decimal(10**field.max_digits - 1).scaleb(-field.decimal_places)
        case models.DateTimeField():
            return LATEST
        case models.DateField():
            return date.max
        case models.TimeField():
            return time.max
        case models.DurationField():
            return timedelta(days=99_999_999, microseconds=1)
        case models.BinaryField():
            return bytes(range(256))
    raise NotImplementedError(f"{field} is of a type for which no value was thought of")


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
        case models.DecimalField():
            return [Decimal(10**field.max_digits)]
    return []


def fill_every_column() -> None:
    """Store three rows of every model of a backup: each column at its limit; null where it may be, else as little
    as it takes; and as the model makes it by itself."""
    with transaction.atomic():
        for table in tables():
            for number in (1, 2, 3):
                row = table.model(**_values(table, number))
                table.model._base_manager.bulk_create([row])
        connection.check_constraints()


def _values(table: BackupTable, number: int) -> dict[str, Any]:
    values = {
        field.attname: _value(field, number)
        for field in table.fields
        if number < 3 or field.is_relation or field.unique or not field.has_default()
    }
    return {**values, **TOGETHER.get(table.name, {})}


def _value(field: models.Field, number: int) -> Any:
    is_counted = field.primary_key or (field.is_relation and (number == 1 or not field.null))
    if is_counted:
        return number
    if number > 1 and field.null:
        return None
    full = at_the_limit(field)
    if number == 1:
        return full
    match full:  # others than those of the first row
        case str():
            return f"{number}ä'\"\\"[: field.max_length]
        case bool():
            return False
        case int():
            return number
        case datetime() | date() | time() | UUID():
            return full
    return type(full)()
