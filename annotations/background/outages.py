"""Waiting for a database that is away, locked or full, for as long as a lease lasts.

An outage costs no run: writes are tried again, and whoever still has to stop hands the work back
without counting it as a lost worker.
"""

from __future__ import annotations

import logging
import sqlite3
import time
from collections.abc import Callable, Iterator
from functools import wraps
from typing import ParamSpec, TypeVar

from django.conf import settings
from django.db import InterfaceError, OperationalError, connection

from annotations.background.failures import disk_trouble
from annotations.models.background import LEASE

logger = logging.getLogger(__name__)

TRY_EVERY = 1.0 / settings.WORK_TEMPO
OUTAGES = (InterfaceError, OperationalError)

# PostgreSQL: connections lost or refused, shut down, too many; a transaction that lost against another.
SQLSTATES = ("08", "57P", "53300", "40")
# The low byte of SQLite's code: busy, locked, input or output, cannot open, locking protocol.
SQLITE_CODES = (5, 6, 10, 14, 15)

P = ParamSpec("P")
R = TypeVar("R")


class DatabaseAway(Exception):
    """A write was tried for as long as a lease lasts. ``since`` is when it first failed (monotonic)."""

    def __init__(self, error: Exception, since: float):
        super().__init__(str(error))
        self.error = error
        self.since = since


def is_outage(error: BaseException) -> bool:
    """Tell whether the same write may succeed later. Otherwise the program or the database has a fault."""
    if not isinstance(error, OUTAGES):
        return False
    cause = error.__cause__
    if isinstance(cause, sqlite3.Error):
        code = getattr(cause, "sqlite_errorcode", None)
        return code is None or code & 0xFF in SQLITE_CODES or disk_trouble(error) is not None
    state = getattr(cause, "sqlstate", None)
    return state is None or state.startswith(SQLSTATES) or disk_trouble(error) is not None


def outlasting(write: Callable[P, R]) -> Callable[P, R]:
    """Decorate ``write`` to be tried again during an outage, except inside a transaction.

    Raises DatabaseAway once it has failed for as long as a lease lasts.
    """

    @wraps(write)
    def trying(*args: P.args, **kwargs: P.kwargs) -> R:
        if connection.in_atomic_block:
            return write(*args, **kwargs)
        since = None
        while True:
            try:
                result = write(*args, **kwargs)
            except OUTAGES as error:
                if not is_outage(error):
                    raise
                if since is None:
                    since = time.monotonic()
                    logger.warning("A write will be tried again: %s", error)
                if time.monotonic() - since > LEASE.total_seconds():
                    raise DatabaseAway(error, since) from error
                connection.close()
                time.sleep(TRY_EVERY)
            else:
                if since is not None:
                    logger.warning("Written after %.1f s.", time.monotonic() - since)
                return result

    return trying


def attempts(patience: float) -> Iterator[float]:
    """Yield the seconds passed each time it is worth another try, for ``patience`` seconds."""
    began = time.monotonic()
    while (passed := time.monotonic() - began) <= patience:
        yield passed
        connection.close()
        time.sleep(TRY_EVERY)


def outage_sentence(error: BaseException, seconds: float) -> str:
    """Say what kept the database from being written, and for how long."""
    span = f"{seconds:.0f} s" if seconds >= 1 else "a moment"
    if trouble := disk_trouble(error):
        return f"The database's disk was {trouble.state} for {span}"
    if "locked" in str(error):
        return f"The database was locked by another writer for {span}"
    return f"The database was away for {span}"
