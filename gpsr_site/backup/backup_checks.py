"""A system check: every column of every table can be written into a backup, and read again."""

from __future__ import annotations

from typing import Any

from django.core.checks import Error
from django.db.models import Field

from annotations.rows.column_values import can_be_json
from gpsr_site.backup.backup_tables import tables

CODE = "gpsr_site.E001"


def check_columns(**options: Any) -> list[Error]:
    """Return an error for each column that a backup and the archive of a world could not hold."""
    return [error for table in tables() for field in table.fields for error in check_column(field)]


def check_column(field: Field[Any, Any]) -> list[Error]:
    """Return an error where ``field`` is of a type that does not read its own text."""
    if can_be_json(field):
        return []
    said = f"A backup cannot hold a {type(field).__name__}, which does not read what it writes."
    hint = (
        "Give the type “value_to_string” and “to_python”, or take one of Django's for the column."
    )
    return [Error(said, hint, obj=field, id=CODE)]
