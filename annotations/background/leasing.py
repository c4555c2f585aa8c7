"""A thread beside the work that extends its lease and looks for a request to stop."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from typing import Any, Self

from django.conf import settings
from django.db import DatabaseError, connections

from annotations.background.fencing import Fenced, extend, is_cancel_requested
from annotations.background.outages import DatabaseAway
from annotations.models.background import LEASE, BackgroundWork

logger = logging.getLogger(__name__)

EXTEND_EVERY = 10 / settings.WORK_TEMPO
LISTEN_EVERY = min(1.0, EXTEND_EVERY / 2)
STOP_WITHIN = 3.0


class Stopped(Exception):
    """The work is to stop: it was cancelled, or is no longer this worker's."""


class Lease:
    """Holds claimed work while its block lasts. ``check`` raises Stopped once it is to stop.

    The block has ``STOP_WITHIN`` seconds to notice; then ``give_up`` is called (a worker's child
    leaves there: some work looks at nothing for minutes).
    """

    def __init__(self, work: BackgroundWork, give_up: Callable[[], None] | None = None):
        self.work = work
        self.is_lost = False
        self.outage: DatabaseAway | None = None
        self._is_away = False
        self._give_up = give_up
        self._stopping = threading.Event()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._keep, name="lease", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *raised: Any) -> None:
        self._over.set()
        self._thread.join()

    def check(self) -> None:
        """Raises Stopped when the work is to stop, DatabaseAway when the database has been away for the
        whole lease; otherwise does nothing, at no cost."""
        if self.outage:
            raise self.outage
        if self._stopping.is_set():
            raise Stopped("No longer this worker's." if self.is_lost else "Cancelled.")

    def _keep(self) -> None:
        extended = time.monotonic()
        try:
            while not self._over.wait(LISTEN_EVERY) and not self._stopping.is_set():
                extended = self._look(extended)
        finally:
            connections.close_all()
        if self._stopping.is_set() and not self._over.wait(STOP_WITHIN) and self._give_up:
            self._give_up()

    def _look(self, extended: float) -> float:
        """Read the cancel flag and extend the lease when it is time. Return when it was last extended.

        A database that returns before the work has noticed that it was away changes nothing.
        """
        now = time.monotonic()
        try:
            is_cancelled = is_cancel_requested(self.work)
            self._is_away = False
            if is_cancelled:
                self._stopping.set()
            elif now - extended >= EXTEND_EVERY:
                extend(self.work)
                self.outage = None
                return now
        except Fenced as error:
            # The block may go on for a moment after it has ended the work itself.
            if not self.work.is_ended:
                logger.warning("%s", error)
                self.is_lost = True
                self._stopping.set()
        except DatabaseError as error:
            if not self._is_away:
                logger.warning("The lease of %s cannot be extended now: %s", self.work, error)
            self._is_away = True
            connections.close_all()
            if time.monotonic() - extended > LEASE.total_seconds():
                self.outage = DatabaseAway(error, extended)
        return extended
