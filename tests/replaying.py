"""Rows that many tests begin with: made in earnest for the first of them, then written again as they were."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from django.db import connection

from annotations.models import World

Numbers = dict[str, int]  # the last id of each table
Write = tuple[str, Any, bool]  # a statement, its values, and whether these are many
READS = ("SELECT", "SAVEPOINT", "RELEASE")


@dataclass(frozen=True)
class Recording:
    """What a function wrote, the ids that it counted on from, and what it returned for ``world``."""

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
        with connection.cursor() as cursor:
            for sql, values, many in self.writes:
                (cursor.executemany if many else cursor.execute)(sql, values)
                cursor.fetchall()  # a write that returns its row is done when that is read
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
    returned, writes = call_and_note(make, world)
    recordings.append(Recording(numbers, last_ids(), writes, *deepcopy((world, returned))))
    return returned


def call_and_note(make: Callable[[World], Any], world: World) -> tuple[Any, list[Write]]:
    """Return ``make(world)`` and what it wrote."""
    writes: list[Write] = []

    def note(execute, sql, values, many, context):
        values = list(values) if many else values
        if not sql.startswith(READS):
            writes.append((sql, values, many))
        return execute(sql, values, many, context)

    with connection.execute_wrapper(note):
        return make(world), writes


def last_ids() -> Numbers:
    with connection.cursor() as cursor:
        cursor.execute("SELECT name, seq FROM sqlite_sequence")
        return dict(cursor.fetchall())
