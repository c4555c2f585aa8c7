"""Which rows a backup holds, and how a row becomes a line of JSON and a row again."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import date, datetime
from typing import Any

from django.apps import apps
from django.db import connections, models, transaction
from django.db.backends.base.base import BaseDatabaseWrapper
from django.db.models import JSONField

from annotations.models import LogInSession

APPS = ("annotations", "parser_service")
# Of single sign-on, where it is set up.
SIGN_ON_APPS = ("account", "socialaccount")
# Log-ins end with the installation, and permissions of Django's own have other keys in each database.
LEFT_OUT = ("User_groups", "User_user_permissions")
SNAPSHOT = "snapshot"
CHUNK = 2000  # rows that are held at once


@dataclass(frozen=True)
class Table:
    """A model with the columns of its rows, in the order of the model."""

    model: type[models.Model]

    @property
    def name(self) -> str:
        return self.model._meta.label_lower

    @property
    def fields(self) -> list[models.Field]:
        return list(self.model._meta.concrete_fields)

    @property
    def columns(self) -> list[str]:
        return [field.column for field in self.fields]

    def lines(self, using: str) -> Iterator[str]:
        """Yield every row as a line of JSON, the same for each database, in the order of keys."""
        names = [field.attname for field in self.fields]
        rows = self.model._base_manager.using(using).order_by("pk").values_list(*names)
        for row in rows.iterator(chunk_size=CHUNK):
            yield json.dumps(row, sort_keys=True, separators=(",", ":"), default=_to_json) + "\n"

    def values(self, line: bytes, connection: BaseDatabaseWrapper) -> list[Any]:
        """Return the values of a line as ``connection`` stores them.

        Raises:
            ValueError: the line does not hold a value for each column.
        """
        row = json.loads(line)
        if not isinstance(row, list) or len(row) != len(self.fields):
            raise ValueError(f"a row of {self.name} has other columns than this version")
        return [
            _to_column(field, value, connection)
            for field, value in zip(self.fields, row, strict=True)
        ]


def tables() -> list[Table]:
    """Return the tables of a backup, by name."""
    found = [
        Table(model)
        for app in (*APPS, *SIGN_ON_APPS)
        if app in apps.app_configs
        for model in apps.get_app_config(app).get_models(include_auto_created=True)
        if model.__name__ not in LEFT_OUT and model is not LogInSession
    ]
    return sorted(found, key=lambda table: table.name)


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


def _to_json(value: Any) -> str:
    if isinstance(value, datetime | date):
        return value.isoformat()
    if isinstance(value, bytes | memoryview):
        return base64.b64encode(bytes(value)).decode()
    raise TypeError(f"A backup cannot hold a {type(value).__name__}.")


def _to_column(field: models.Field, value: Any, connection: BaseDatabaseWrapper) -> Any:
    if isinstance(field, JSONField):
        if value is None and not field.null:  # JSON's null, which is a value
            return connection.ops.adapt_json_value(None, field.encoder)
    else:
        value = field.to_python(value)
    return field.get_db_prep_value(value, connection, prepared=False)
