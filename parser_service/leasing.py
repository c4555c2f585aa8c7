"""A thread beside the training that keeps the run's lease and listens for a request to stop."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import Self

from django.conf import settings
from django.db import DatabaseError, connections

from parser_service import lifecycle
from parser_service.models import TrainingRun
from parser_service.parsers.interface import Cancelled

logger = logging.getLogger(__name__)

EXTEND_EVERY = 10 / settings.WORK_TEMPO
LISTEN_EVERY = min(1.0, EXTEND_EVERY / 2)
STOP_WITHIN = 3.0


class Lease:
    """Holds a claimed run while its block lasts. ``check`` raises Cancelled once it is to stop.

    The block has ``STOP_WITHIN`` seconds to notice; then ``give_up`` is called (a worker's child
    leaves there: some work looks at nothing for minutes).
    """

    def __init__(self, run: TrainingRun, give_up: Callable[[], None] | None = None):
        self.run = run
        self.is_lost = False
        self._give_up = give_up
        self._stopping = threading.Event()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._keep, name="lease", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._over.set()
        self._thread.join()

    def check(self) -> None:
        """Raises Cancelled when the run is to stop; otherwise nothing, at no cost."""
        if self._stopping.is_set():
            raise Cancelled("The run is no longer this worker's." if self.is_lost else "Cancelled.")

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
        """Reads the cancel flag and, when it is time, extends; when the lease was last extended."""
        now = time.monotonic()
        try:
            if lifecycle.is_cancel_requested(self.run):
                self._stopping.set()
            elif now - extended >= EXTEND_EVERY:
                lifecycle.extend(self.run)
                return now
        except lifecycle.Fenced as fenced:
            self._lose(str(fenced))
        except DatabaseError as error:
            logger.warning("The lease of run %s was not looked at: %s", self.run.pk, error)
            connections.close_all()
            if now - extended > lifecycle.LEASE.total_seconds():
                self._lose(f"Run {self.run.pk}: no database for the whole lease.")
        return extended

    def _lose(self, reason: str) -> None:
        logger.warning("%s", reason)
        self.is_lost = True
        self._stopping.set()
