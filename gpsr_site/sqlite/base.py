"""Django's SQLite, with the limits that PostgreSQL holds by itself.

SQLite stores a text of any length in a column of 500 characters, and a number of 63 bits in one of 15.
Such a row could not be moved to PostgreSQL. A constraint beside each column refuses it when it is
written, in bulk too, with an IntegrityError that names the constraint.
"""

from __future__ import annotations

import os
import sqlite3
from pathlib import Path
from typing import Any

from django.db.backends.sqlite3 import base, operations
from django.db.models.constants import OnConflict

_COLUMN = '"%(column)s"'
_SHORT = f"length({_COLUMN}) <= %(max_length)s"
# length() counts to the first NUL, and PostgreSQL takes none.
_NO_NUL = f"instr({_COLUMN}, char(0)) = 0"
# Without the escaped backslashes: after one, "u0000" is text.
_NO_NUL_IN_JSON = f"instr(replace({_COLUMN}, '\\\\', ''), '\\u0000') = 0"
_TEXT = f"{_SHORT} AND {_NO_NUL}"


def _between(least: int, most: int) -> str:
    return f"{_COLUMN} BETWEEN {least} AND {most}"


class DatabaseOperations(operations.DatabaseOperations):
    """Ignore rows that are there already, as PostgreSQL does. ``OR IGNORE`` would ignore any broken limit too."""

    def insert_statement(self, on_conflict: OnConflict | None = None) -> str:
        return "INSERT INTO"

    def on_conflict_suffix_sql(
        self,
        fields: Any,
        on_conflict: OnConflict | None,
        update_fields: Any,
        unique_fields: Any,
    ) -> str:
        if on_conflict == OnConflict.IGNORE:
            return "ON CONFLICT DO NOTHING"
        return str(
            super().on_conflict_suffix_sql(fields, on_conflict, update_fields, unique_fields)
        )


class DatabaseWrapper(base.DatabaseWrapper):
    """A connection whose tables are made with these constraints, and which reads from a read-only disk."""

    ops_class = DatabaseOperations

    data_type_check_constraints = {
        **base.DatabaseWrapper.data_type_check_constraints,
        **dict.fromkeys(("CharField", "SlugField", "FileField", "FilePathField"), _TEXT),
        "TextField": _NO_NUL,
        "JSONField": f"(JSON_VALID({_COLUMN}) AND {_NO_NUL_IN_JSON} OR {_COLUMN} IS NULL)",
        "SmallIntegerField": _between(-(2**15), 2**15 - 1),
        "PositiveSmallIntegerField": _between(0, 2**15 - 1),
        "IntegerField": _between(-(2**31), 2**31 - 1),
        "PositiveIntegerField": _between(0, 2**31 - 1),
    }

    def get_new_connection(self, conn_params: dict[str, Any]) -> Any:
        """Open the database. On a disk that cannot be written it is opened for reading, where no log lies
        beside it: with one, SQLite reads both by itself. Raises OperationalError."""
        try:
            return super().get_new_connection(conn_params)
        except sqlite3.OperationalError:
            path = Path(conn_params["database"])
            if os.access(path.parent, os.W_OK) or Path(f"{path}-wal").exists():
                raise
            address = f"{path.resolve().as_uri()}?immutable=1"
            return super().get_new_connection({**conn_params, "database": address, "uri": True})
