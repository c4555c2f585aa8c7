"""Which rows a backup holds, and how a row becomes a line of JSON and a row again."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import isfinite, isnan
from typing import Any

from django.apps import apps
from django.core.exceptions import ValidationError
from django.db import connections, models, transaction
from django.db.backends.base.base import BaseDatabaseWrapper
from django.db.backends.base.operations import BaseDatabaseOperations
from django.db.models import JSONField

from annotations.language.texts import Refusal, has_half_character
from annotations.models import LogInSession
from annotations.rows.column_values import as_json, from_json

APPS = ("annotations", "parser_service")
# Of single sign-on, where it is set up.
SIGN_ON_APPS = ("account", "socialaccount")
# Log-ins end with the installation, and permissions of Django's own have other keys in each database.
LEFT_OUT = ("User_groups", "User_user_permissions")
SNAPSHOT = "snapshot"
CHUNK = 2000  # rows that are held at once
RANGES = BaseDatabaseOperations.integer_field_ranges
DEEPEST = 500  # levels of a JSON value: Python reads and writes about a thousand


@dataclass(frozen=True)
class BackupTable:
    """A model with the columns of its rows, in the order of the model.

    ``limits`` are fields that bound a column more narrowly than those of the model, by ``attname``.
    """

    model: type[models.Model]
    limits: Mapping[str, models.Field[Any, Any]] = field(default_factory=dict)

    @property
    def name(self) -> str:
        return self.model._meta.label_lower

    @property
    def fields(self) -> list[models.Field[Any, Any]]:
        return list(self.model._meta.concrete_fields)

    @property
    def columns(self) -> list[str]:
        return [field.column for field in self.fields if field.column]

    def lines(self, using: str) -> Iterator[str]:
        """Yield every row as a line of JSON, the same for each database, in the order of keys.

        Raises:
            Unportable: a row holds what not every database can hold.
        """
        fields = self.fields
        names = [field.attname for field in fields]
        rows = self.model._base_manager.using(using).order_by("pk").values_list(*names)
        for row in rows.iterator(chunk_size=CHUNK):
            self._require_portable(row)
            values = [as_json(*each) for each in zip(fields, row, strict=True)]
            yield json.dumps(values, sort_keys=True, separators=(",", ":")) + "\n"

    def values(self, line: bytes, connection: BaseDatabaseWrapper) -> list[Any]:
        """Return the values of a line as ``connection`` stores them.

        Raises:
            Unportable: the row holds what not every database can hold.
            Refusal: the line does not hold a value for each column.
        """
        try:
            row = json.loads(line)
        except (ValueError, RecursionError) as error:
            raise Refusal(f"A row of {self.name} is no line of JSON.", "no_backup_row") from error
        if not isinstance(row, list) or len(row) != len(self.fields):
            said = f"A row of {self.name} has other columns than this version."
            raise Refusal(said, "other_columns")
        self._require_portable(row)
        values = []
        for column, value in zip(self.fields, row, strict=True):
            try:
                values.append(_to_column(column, value, connection))
            except ValidationError as error:
                raise Unportable(self, row, column, "holds a value of another type") from error
        return values

    def _require_portable(self, row: Sequence[Any]) -> None:
        if fault := self.fault(row):
            raise fault

    def fault(self, row: Sequence[Any]) -> Unportable | None:
        """Return why not every database can hold ``row``; None where each can."""
        for column, value in zip(self.fields, row, strict=True):
            if fault := fault_of(self.limits.get(column.attname, column), value):
                return Unportable(self, row, column, fault)
        return None


class Unportable(Refusal):
    """A row holds what not every database can hold; the sentence names model, row and column, ``remedy`` the SQL."""

    code = "not_portable"

    def __init__(
        self, table: BackupTable, row: Sequence[Any], field: models.Field[Any, Any], fault: str
    ) -> None:
        place = [each.primary_key for each in table.fields].index(True)
        super().__init__(f"{table.name}, row {row[place]}: {field.column} {fault}.")
        self.remedy = (
            f"(UPDATE {table.model._meta.db_table} SET {field.column} = … "
            f"WHERE {table.fields[place].column} = {row[place]!r};)"
        )


def fault_of(field: models.Field[Any, Any], value: Any) -> str:
    """Return why not every database can hold ``value`` in the column of ``field``; empty where each can.

    SQLite does not limit the length of a text or the range of a number. PostgreSQL takes neither NUL nor lone
    surrogates, in JSON as well, and JSON has neither NaN nor infinity.
    """
    if value is None:
        return ""
    if isinstance(field, models.JSONField):
        return _fault_of_json(value)
    match value:
        case str():
            if fault := _fault_of_text(value):
                return fault
            if isinstance(field, models.CharField) and len(value) > (
                field.max_length or len(value)
            ):
                return f"has {len(value):,} characters; {field.max_length:,} is the limit"
        case bool():
            return ""
        case int():
            least, most = RANGES.get(field.get_internal_type(), RANGES["BigIntegerField"])
            return "" if least <= value <= most else f"is not from {least:,} to {most:,}"
        case float():
            return "is no number (NaN)" if isnan(value) else ""
    return ""


def _fault_of_text(text: str) -> str:
    if text.isascii():
        return "has a NUL character" if "\0" in text else ""
    if has_half_character(text):
        return "has half a character, a lone surrogate"
    return "has a NUL character" if "\0" in text else ""


def _fault_of_json(value: Any) -> str:
    """Look at each text and number in ``value``, without recursion: it may be nested deep."""
    waiting, deepest = [(value, 1)], 0
    while waiting:
        each, depth = waiting.pop()
        deepest = max(deepest, depth)
        match each:
            case str():
                if fault := _fault_of_text(each):
                    return fault
            case float() if not isfinite(each):
                return "has a number that JSON cannot write, NaN or infinite"
            case bool():
                continue
            case float() | int() if abs(each) >= (2**63 if isinstance(each, int) else 1e16):
                return "has a number of so many digits that databases write it differently"
            case list() | tuple():
                waiting += [(inner, depth + 1) for inner in each]
            case dict():
                waiting += [(inner, depth + 1) for pair in each.items() for inner in pair]
    return "" if deepest <= DEEPEST else f"nests more than {DEEPEST} deep"


def tables() -> list[BackupTable]:
    """Return the tables of a backup, by name."""
    in_backup = [
        BackupTable(model)
        for app in (*APPS, *SIGN_ON_APPS)
        if app in apps.app_configs
        for model in apps.get_app_config(app).get_models(include_auto_created=True)
        if model.__name__ not in LEFT_OUT and model is not LogInSession
    ]
    return sorted(in_backup, key=lambda table: table.name)


@contextmanager
def snapshot() -> Iterator[str]:
    """Open a second connection that sees the database as it is now, whatever others write meanwhile.

    Nobody waits for it: SQLite's log and PostgreSQL's versions keep the old rows. Yields its name.
    """
    connection = connections["default"].copy(SNAPSHOT)
    if connection.vendor == "sqlite":
        connection.settings_dict["OPTIONS"]["transaction_mode"] = "DEFERRED"
    connections[SNAPSHOT] = connection
    try:
        with transaction.atomic(using=SNAPSHOT):
            if connection.vendor == "postgresql":
                with connection.cursor() as cursor:
                    cursor.execute("SET TRANSACTION ISOLATION LEVEL REPEATABLE READ, READ ONLY")
            yield SNAPSHOT
    finally:
        connection.close()
        del connections[SNAPSHOT]


def _to_column(field: models.Field[Any, Any], value: Any, connection: BaseDatabaseWrapper) -> Any:
    if isinstance(field, JSONField) and value is None and not field.null:  # JSON's null, a value
        return connection.ops.adapt_json_value(None, field.encoder)
    return field.get_db_prep_value(from_json(field, value), connection, prepared=False)
