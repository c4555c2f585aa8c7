"""Write many rows at once: collect them in a temporary table first, so that nobody waits.

A temporary table belongs to one connection. Filling it takes no lock on the database (SQLite has one
writer), and the transaction that moves the rows to their table is short.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import count
from typing import Any, Self

from django.db import connection, models

from annotations.background.progress import UNWATCHED, Progress
from annotations.rows.synchronise import batches

_NUMBERS = count()
BATCH = 1000  # rows collected between two looks at whether to stop


class Staging:
    """Rows of ``model``: its ``columns`` (as the database calls them), an ``id``, and ``extra`` texts.

    A row with an ``id`` is to change the row that is there; one without is to be new.
    """

    def __init__(
        self, model: type[models.Model], columns: Sequence[str], extra: Sequence[str] = ()
    ) -> None:
        self.model = model
        self.columns = tuple(columns)
        self.extra = tuple(extra)
        self._target = _quote(model._meta.db_table)
        self._table = _quote(f"staged_{next(_NUMBERS)}_{model._meta.model_name}")
        self._number = 0

    def __enter__(self) -> Self:
        taken = ["id AS staged_id", *map(_quote, self.columns)]
        texts = [f"CAST('' AS text) AS {_quote(name)}" for name in self.extra]
        selected = ", ".join(["0 AS staged_number", *taken, *texts])
        with connection.cursor() as cursor:
            cursor.execute(f"DROP TABLE IF EXISTS {self._table}")
            cursor.execute(
                f"CREATE TEMPORARY TABLE {self._table} AS SELECT {selected} FROM {self._target} WHERE 1 = 0"
            )
        return self

    def __exit__(self, *raised: Any) -> None:
        if connection.connection is not None and not connection.needs_rollback:
            with connection.cursor() as cursor:
                cursor.execute(f"DROP TABLE IF EXISTS {self._table}")

    def add(self, rows: Iterable[Sequence[Any]], progress: Progress = UNWATCHED) -> None:
        """Collect rows: each an id or None, then the columns, then the extra texts."""
        width = 2 + len(self.columns) + len(self.extra)
        statement = f"INSERT INTO {self._table} VALUES ({', '.join(['%s'] * width)})"
        with connection.cursor() as cursor:
            for some in batches(rows, BATCH):
                progress.check()
                numbered = [(self._number + place, *row) for place, row in enumerate(some)]
                self._number += len(some)
                cursor.executemany(statement, numbered)

    def add_new(self, rows: Iterable[models.Model], progress: Progress = UNWATCHED) -> None:
        """Collect unsaved instances of the model."""
        by_column = {field.column: field for field in self.model._meta.concrete_fields}
        fields = [by_column[column] for column in self.columns]
        self.add(
            ((None, *(_for_database(field, row) for field in fields)) for row in rows),
            progress,
        )

    def insert(self, **expressions: str) -> int:
        """Write the new rows in their order; ``expressions`` are SQL for further columns. Return how many.

        An expression may use the extra texts as ``s.NAME``.
        """
        names = ", ".join(map(_quote, [*self.columns, *expressions]))
        values = ", ".join([*(f"s.{_quote(name)}" for name in self.columns), *expressions.values()])
        with connection.cursor() as cursor:
            cursor.execute(
                f"INSERT INTO {self._target} ({names}) SELECT {values} FROM {self._table} s "
                "WHERE s.staged_id IS NULL ORDER BY s.staged_number"
            )
            n_rows: int = cursor.rowcount
            return n_rows

    def update(self, **expressions: str) -> int:
        """Write the rows that have an id over those that are there. Return how many."""
        values = {_quote(name): f"s.{_quote(name)}" for name in self.columns}
        values |= {_quote(name): value for name, value in expressions.items()}
        changes = ", ".join(f"{name} = {value}" for name, value in values.items())
        with connection.cursor() as cursor:
            cursor.execute(
                f"UPDATE {self._target} SET {changes} FROM {self._table} s "
                f"WHERE s.staged_id = {self._target}.id"
            )
            n_rows: int = cursor.rowcount
            return n_rows


def prepared(
    model: type[models.Model], columns: Sequence[str], rows: Iterable[models.Model]
) -> list[list[Any]]:
    """Return the ``columns`` of unsaved rows as the database takes them: work that needs no transaction."""
    by_column = {field.column: field for field in model._meta.concrete_fields}
    fields = [by_column[column] for column in columns]
    return [[_for_database(field, row) for field in fields] for row in rows]


def insert_prepared(
    model: type[models.Model], columns: Sequence[str], rows: Sequence[Sequence[Any]]
) -> None:
    """Write rows of ``prepared`` values by one statement, which costs a tenth of saving the instances."""
    table, names = _quote(model._meta.db_table), ", ".join(map(_quote, columns))
    places = ", ".join(["%s"] * len(columns))
    with connection.cursor() as cursor:
        cursor.executemany(f"INSERT INTO {table} ({names}) VALUES ({places})", rows)


def _quote(name: str) -> str:
    return connection.ops.quote_name(name)


def _for_database(field: models.Field[Any, Any], row: models.Model) -> Any:
    is_derived = getattr(field, "is_derived", False)
    value = field.pre_save(row, add=True) if is_derived else getattr(row, field.attname)
    return field.get_db_prep_save(value, connection)
