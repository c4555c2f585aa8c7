"""Rows that many tests begin with: made in earnest for the first of them, then written again as they were."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from django.db import connection

from annotations.models import World

Numbers = dict[str, int]  # the last id of each table
Rows = dict[int, tuple[Any, ...]]  # the rows of a table by their rowid
Write = tuple[str, list[tuple[Any, ...]]]  # a statement, and values for each time it is executed


@dataclass(frozen=True)
class Recording:
    """What a function changed, the ids that it counted on from, and what it returned for ``world``."""

    before: Numbers
    after: Numbers
    writes: list[Write]
    world: World
    returned: Any

    def fits(self, numbers: Numbers) -> bool:
        """Whether the function would give its rows the same ids now."""
        return all(
            numbers.get(table) == self.before.get(table)
            for table, last in self.after.items()
            if last != self.before.get(table)
        )

    def repeat(self, world: World) -> Any:
        for sql, values in self.writes:
            connection.connection.executemany(sql, values)
        known = {id(self.world): world}
        vars(world).update(deepcopy(vars(self.world), known))
        return deepcopy(self.returned, known)


RECORDINGS: dict[tuple[object, ...], list[Recording]] = defaultdict(list)


def made_once(make: Callable[[World], Any], world: World) -> Any:
    """Return ``make(world)``, or a copy of what it was before, with the same rows in the database.

    ``make`` fills an empty world, each time alike. Rows come out alike, ids included, in the
    transactions of SQLite that tests roll back; elsewhere ``make`` is called each time.
    """
    if connection.vendor != "sqlite" or not connection.in_atomic_block:
        return make(world)
    recordings = RECORDINGS[make, world.pk, world.name]
    numbers = last_ids()
    for recording in recordings:
        if recording.fits(numbers):
            return recording.repeat(world)
    tables = {name: rows_of(name, columns) for name, columns in columns_of_tables()}
    returned = make(world)
    writes = [
        write
        for name, columns in columns_of_tables()
        for write in changes(name, columns, tables[name], rows_of(name, columns))
    ]
    recordings.append(Recording(numbers, last_ids(), writes, *deepcopy((world, returned))))
    return returned


def last_ids() -> Numbers:
    return dict(connection.connection.execute("SELECT name, seq FROM sqlite_sequence").fetchall())


def columns_of_tables() -> Iterator[tuple[str, list[str]]]:
    """Yield each table with those of its columns that can be written."""
    for name in connection.introspection.table_names():
        about = connection.connection.execute(f'PRAGMA table_info("{name}")').fetchall()
        yield name, [f'"{column[1]}"' for column in about]


def rows_of(table: str, columns: list[str]) -> Rows:
    selected = ", ".join(["rowid", *columns])
    rows = connection.connection.execute(f'SELECT {selected} FROM "{table}"').fetchall()
    return {row[0]: row[1:] for row in rows}


def changes(table: str, columns: list[str], before: Rows, after: Rows) -> Iterator[Write]:
    """Yield what makes the rows ``after`` of those ``before``. Rows are changed column by column, since
    their other columns may hold something else the next time."""
    new = [values for number, values in after.items() if number not in before]
    if new:
        places = ", ".join("?" * len(columns))
        yield f'INSERT INTO "{table}" ({", ".join(columns)}) VALUES ({places})', new
    for number in before.keys() & after.keys():
        for column, was, value in zip(columns, before[number], after[number], strict=True):
            if was != value:
                yield f'UPDATE "{table}" SET {column} = ? WHERE rowid = ?', [(value, number)]
    if gone := [(number,) for number in before.keys() - after.keys()]:
        yield f'DELETE FROM "{table}" WHERE rowid = ?', gone
