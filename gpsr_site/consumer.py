"""Read messages from the broker, and wait longer after each refusal."""

from __future__ import annotations

import logging
import time

from celery.worker import consumer

logger = logging.getLogger(__name__)

LONGEST_WAIT = 32.0  # seconds


class PatientConsumer(consumer.Consumer):
    """Wait before the next attempt if the broker refuses: its virtual host or its account is gone.

    Celery's own tries at once, and each attempt writes lines into the log, many a second.
    """

    _wait = 1.0
    _refused_at = 0.0

    def on_connection_error_before_connected(self, exc: Exception) -> None:
        """Log why the broker refuses, and wait twice as long as before, ``LONGEST_WAIT`` at most.

        The worker's timer and its quick stop run in another thread and do not wait.
        """
        if time.monotonic() - self._refused_at > 2 * LONGEST_WAIT:
            self._wait = 1.0
        logger.error("The broker refuses this worker: %s. Next attempt in %g s.", exc, self._wait)
        time.sleep(self._wait)
        self._wait = min(2 * self._wait, LONGEST_WAIT)
        self._refused_at = time.monotonic()
