"""Indexes of trigrams on PostgreSQL, so that a search does not read all texts."""

from __future__ import annotations

import sys
from typing import Any

from django.db import DatabaseError, migrations, transaction

# What the searches of long lists look at.
SEARCHED = {
    "Command": ["anonymized_text"],
    "LogicalForm": ["text"],
    "Paraphrase": ["utterance", "prompt"],
    "Utterance": ["text"],
    "WorkItem": ["title", "reason"],
    "Example": ["utterance", "source_command"],
}
WITHOUT = (
    "The extension pg_trgm cannot be made here, so searches will read all texts. Let an administrator of the database "
    "run CREATE EXTENSION pg_trgm, and then: gpsr-workbench manage migrate annotations 0047, gpsr-workbench manage migrate\n"
)


def make(apps: Any, editor: Any) -> None:
    if editor.connection.vendor != "postgresql":
        return
    try:
        with transaction.atomic(using=editor.connection.alias):
            editor.execute("CREATE EXTENSION IF NOT EXISTS pg_trgm")
    except DatabaseError:
        sys.stderr.write(WITHOUT)
        return
    for table, column, name in indexes(apps):
        # As Django asks for a text in whatever case.
        editor.execute(
            f'CREATE INDEX "{name}" ON "{table}" USING gin (UPPER("{column}"::text) gin_trgm_ops)'
        )


def drop(apps: Any, editor: Any) -> None:
    for _, _, name in indexes(apps):
        editor.execute(f'DROP INDEX IF EXISTS "{name}"')


def indexes(apps: Any) -> list[tuple[str, str, str]]:
    """Return table, column and name of each index."""
    tables = {name: apps.get_model("annotations", name)._meta.db_table for name in SEARCHED}
    return [
        (tables[name], column, f"{name.lower()}_{column}_trigrams")
        for name, columns in SEARCHED.items()
        for column in columns
    ]


class Migration(migrations.Migration):
    dependencies = [("annotations", "0047_lists_in_order")]
    operations = [migrations.RunPython(make, drop, elidable=False)]
