"""What a database does for a request, counted by itself, so that it is the same on a busy machine."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from django.db import connection

STEPS_AT_ONCE = 10
ROWS_READ = """
    SELECT coalesce(sum(pg_stat_get_xact_tuples_returned(oid)), 0) FROM pg_class
    WHERE relkind IN ('r', 'i') AND relnamespace = 'public'::regnamespace
"""


@dataclass
class Work:
    """On PostgreSQL, rows and entries of indexes that were read; on SQLite, steps of its virtual machine, some
    ten for each row that it looks at."""

    done: int = 0


@contextmanager
def counted_work() -> Iterator[Work]:
    """Count what the database does in the block. On PostgreSQL the block has to be in a transaction."""
    work = Work()
    if connection.vendor == "sqlite":
        connection.ensure_connection()

        def count() -> None:
            work.done += STEPS_AT_ONCE

        connection.connection.set_progress_handler(count, STEPS_AT_ONCE)
        try:
            yield work
        finally:
            connection.connection.set_progress_handler(None, 0)
    else:
        before = rows_read()
        yield work
        work.done = rows_read() - before


def rows_read() -> int:
    """Return how many rows PostgreSQL has read in this transaction."""
    with connection.cursor() as cursor:
        cursor.execute(ROWS_READ)
        return int(cursor.fetchone()[0])
