"""The worker: a task that carries out the oldest queued work, and the timer in the parent process.

The parent never imports torch. Its timer ticks while a child works; a child does one piece of work.
"""

from __future__ import annotations

import logging
import os
import signal
import socket
import threading
from contextlib import suppress
from datetime import timedelta
from functools import partial
from typing import Any

from celery import bootsteps, shared_task
from celery.signals import worker_process_init
from django.conf import settings
from django.db import connections
from django.utils import timezone

from annotations import background
from annotations.background import TASK, message_queue
from annotations.background.waking import WAKE_AFTER
from annotations.models.background import BackgroundWork, Queue
from parser_service.models import Worker
from parser_service.runs.orphan_folders import remove_orphans

logger = logging.getLogger(__name__)

TICK = 5 / settings.WORK_TEMPO
REPLACE_EVERY = 0.5  # seconds; Celery looks every 5 for a child whose end it missed
STOP_WITHIN = 4.0
FORGET_AFTER = timedelta(days=1)
NICENESS = 5  # a page that is asked for while a network trains is served first


@shared_task(bind=True, name=TASK)
def work_next(task: Any, queue: str) -> None:
    """Carry out the oldest work of the next served queue in turn; outside a worker, of ``queue``."""
    queues = _served_queues() or [queue]
    if work := background.claim_in_turn(task.request.hostname, queues):
        background.carry_out(work, partial(_leave, work))
        background.wake_for_next(queues)


def _served_queues() -> list[str]:
    """Return the queues that this worker serves; none outside a worker."""
    consumed = background.queue_app().amqp.queues.consume_from
    return [queue for queue in Queue.values if message_queue(queue) in consumed]


def _leave(work: BackgroundWork) -> None:
    """End the child, which did not notice in time that its work is to stop."""
    try:
        with suppress(background.Fenced):
            background.acknowledge_cancel(work)
    finally:
        os._exit(os.EX_OK)  # the pool logs any other as a fault


@worker_process_init.connect
def begin_child(**_: Any) -> None:
    """Lower the priority of this child, and end it when its parent ends."""
    parent = os.getppid()

    def leave_with_parent() -> None:
        while os.getppid() == parent:
            threading.Event().wait(1)
        os._exit(1)

    os.nice(NICENESS)
    threading.Thread(target=leave_with_parent, daemon=True).start()


class WorkerTimer(bootsteps.StartStopStep):
    """The timer of a worker's parent process, and its quick stop."""

    requires = ("celery.worker.components:Pool",)

    def __init__(self, worker: Any, **options: Any):
        super().__init__(worker, **options)
        self._stopping = threading.Event()
        self._leases = background.LeaseWatch()
        # A child is never forked in the middle of a tick: it would inherit locks that nobody frees.
        self._quiet = threading.Lock()

    def start(self, worker: Any) -> None:
        """Start the timer. Replaces Celery's signal handlers, which are set by now."""
        self._worker = worker
        self._name = worker.hostname
        self._queues = _served_queues()
        os.register_at_fork(
            before=self._quiet.acquire,
            after_in_parent=self._quiet.release,
            after_in_child=self._quiet.release,
        )
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGQUIT, signal.SIGHUP):
            signal.signal(number, lambda *_: self._stopping.set())
        threading.Thread(target=self._keep_ticking, name="timer", daemon=True).start()

    def register_with_event_loop(self, worker: Any, hub: Any) -> None:
        """Replace an ended child soon (with brokers that have an event loop)."""
        hub.call_repeatedly(REPLACE_EVERY, worker.pool._pool.maintain_pool)

    def _keep_ticking(self) -> None:
        waited = timedelta(0)  # the messages of all that is queued may be lost at the start
        while True:
            with self._quiet:
                self._tick(waited)
            waited = WAKE_AFTER
            if self._stopping.wait(TICK):
                self._stop()

    def _tick(self, waited: timedelta) -> None:
        """Do the timer's work once. Errors are logged; the next tick comes anyway."""
        try:
            now = timezone.now()
            row = {
                "host": socket.gethostname(),
                "process_id": os.getpid(),
                "last_seen": now,
                "queue": ",".join(self._queues),
            }
            Worker.objects.update_or_create(name=self._name, defaults=row)  # the banner reads it
            Worker.objects.filter(last_seen__lt=now - FORGET_AFTER).delete()
            if self._leases.is_trusted():
                for kind in background.kinds():
                    background.requeue_expired(kind)
            background.wake_for_forgotten(self._name, self._queues, waited)
            if orphans := remove_orphans():
                logger.info("Removed the folders of deleted runs: %s", orphans)
        except Exception as error:
            self._leases.distrust()
            logger.warning("The worker's timer could not do its work: %s", error)
        finally:
            connections.close_all()

    def _stop(self) -> None:
        """Kill the child, give its work back to the queue and end the process."""
        watchdog = threading.Timer(STOP_WITHIN, os._exit, [1])
        watchdog.daemon = True
        watchdog.start()
        try:
            for process in self._worker.pool.info["processes"]:
                with suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
            for kind in background.kinds():
                for work in background.hand_back(self._name, kind):
                    logger.info("The queue has %s again.", work)
            Worker.objects.filter(name=self._name).delete()
        except Exception as error:
            logger.warning("The worker's work goes on when its lease is over: %s", error)
        finally:
            os._exit(0)
