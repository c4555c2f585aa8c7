"""Read messages from the broker: none while work lasts, and more slowly after each refusal."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from typing import Any

from celery.exceptions import WorkerLostError
from celery.worker import consumer, request, state

logger = logging.getLogger(__name__)

LONGEST_WAIT = 32.0  # seconds
LOOK_EVERY = 0.25  # seconds; whether the child is free again


class PatientConsumer(consumer.Consumer):
    """Take one message, and the next when its work is over. Wait before the next attempt if the broker refuses.

    Celery's own holds a second message while a child works: another worker cannot have it, and RabbitMQ
    closes the channel of who holds one for half an hour. And where a virtual host or an account is gone, it
    tries again at once, with lines in the log each time.
    """

    _wait = 1.0
    _refused_at = 0.0

    def create_task_handler(self, *args: Any, **kwargs: Any) -> Callable[[Any], None]:
        """Return what is called with each message."""
        handle = super().create_task_handler(*args, **kwargs)

        def receive(message: Any) -> None:
            self.task_consumer.cancel()
            if _is_busy():  # the connection is new, the work is not
                message.requeue()
            else:
                handle(message)
            if self.hub is None:  # the loop of the filesystem broker: nothing else waits for it
                while _is_busy():
                    time.sleep(LOOK_EVERY)
                self._read_on()

        return receive

    def register_with_event_loop(self, hub: Any) -> None:
        super().register_with_event_loop(hub)
        hub.call_repeatedly(LOOK_EVERY, self._read_on)

    def _read_on(self) -> None:
        """Ask the broker for messages again once the work is over; ask nothing where that is done already."""
        if self.task_consumer and not _is_busy():
            self.task_consumer.consume()

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


class WakeUp(request.Request):
    """A message that a worker has taken."""

    def on_failure(
        self, exc_info: Any, send_failed_event: bool = True, return_ok: bool = False
    ) -> None:
        """Log no traceback of this process for a child that is gone: it ends itself where its work is cancelled, and of
        any other end the pool logs a line."""
        is_gone = isinstance(exc_info.exception, WorkerLostError)
        super().on_failure(exc_info, send_failed_event, return_ok or is_gone)


def _is_busy() -> bool:
    """Return whether a message's work waits for the child or runs there."""
    return bool(state.reserved_requests or state.active_requests)
