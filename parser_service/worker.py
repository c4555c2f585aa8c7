"""The worker: a task that trains the oldest queued run, and the timer in the parent process.

The parent never imports torch. Its timer ticks while a child trains; a child trains one run.
"""

from __future__ import annotations

import logging
import os
import signal
import socket
import threading
from collections.abc import Iterable
from contextlib import suppress
from datetime import timedelta
from functools import partial
from typing import Any

from celery import bootsteps, shared_task
from celery.signals import worker_process_init
from django.conf import settings
from django.db import connections
from django.utils import timezone

from parser_service import lifecycle
from parser_service.models import TrainingRun, Worker
from parser_service.models.runs import Queue
from parser_service.training import train
from parser_service.waking import TASK, WAKE_AFTER, message_queue, wake_for_forgotten, wake_for_next

logger = logging.getLogger(__name__)

TICK = 5 / settings.WORK_TEMPO
STOP_WITHIN = 4.0
FORGET_AFTER = timedelta(days=1)
NICENESS = 5  # a page that is asked for while a network trains is served first


@shared_task(bind=True, name=TASK)
def train_next(task: Any, queue: str) -> None:
    """What a wake-up does. The run that it was sent for may be another's by now."""
    if run := lifecycle.claim(task.request.hostname, queue):
        train(run, partial(_leave, run))
        wake_for_next(queue)


def _leave(run: TrainingRun) -> None:
    """Ends the child that did not notice in time that its run is to stop."""
    try:
        with suppress(lifecycle.Fenced):
            lifecycle.acknowledge_cancel(run)
    finally:
        os._exit(1)


@worker_process_init.connect
def begin_child(**_: Any) -> None:
    """Lets pages go first, and sees to it that no child outlives its parent."""
    os.nice(NICENESS)
    threading.Thread(target=_leave_with, args=(os.getppid(),), daemon=True).start()


def _leave_with(parent: int) -> None:
    while os.getppid() == parent:
        threading.Event().wait(1)
    os._exit(1)


class Service(bootsteps.StartStopStep):
    """The timer of a worker's parent process, and its stop: cold, in seconds, nothing lost."""

    requires = ("celery.worker.components:Pool",)

    def __init__(self, worker: Any, **options: Any):
        super().__init__(worker, **options)
        self._stopping = threading.Event()
        # A child is never forked in the middle of a tick: it would inherit locks that nobody frees.
        self._quiet = threading.Lock()

    def start(self, worker: Any) -> None:
        """Called once the pool is there; Celery's own handlers are set by then and are replaced."""
        self._worker = worker
        self._name = worker.hostname
        consumed = worker.app.amqp.queues.consume_from
        self._queues = [queue for queue in Queue.values if message_queue(queue) in consumed]
        os.register_at_fork(
            before=self._quiet.acquire,
            after_in_parent=self._quiet.release,
            after_in_child=self._quiet.release,
        )
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGQUIT, signal.SIGHUP):
            signal.signal(number, lambda *_: self._stopping.set())
        threading.Thread(target=self._keep_ticking, name="timer", daemon=True).start()

    def _keep_ticking(self) -> None:
        waited = timedelta(0)  # at the start every queued run may be one whose message was lost
        while True:
            with self._quiet:
                self._tick(waited)
            waited = WAKE_AFTER
            if self._stopping.wait(TICK):
                self._stop()

    def _tick(self, waited: timedelta) -> None:
        """Whatever goes wrong, the next tick comes."""
        try:
            self._tell_of_us()
            lifecycle.requeue_expired()
            wake_for_forgotten(self._name, self._queues, waited)
        except Exception as error:
            logger.warning("The worker's timer could not do its work: %s", error)
        finally:
            connections.close_all()

    def _tell_of_us(self) -> None:
        """Writes the row that the banner reads."""
        now = timezone.now()
        us = {"host": socket.gethostname(), "process_id": os.getpid(), "last_seen": now}
        Worker.objects.update_or_create(
            name=self._name, defaults={**us, "queue": ",".join(self._queues)}
        )
        Worker.objects.filter(last_seen__lt=now - FORGET_AFTER).delete()

    def _stop(self) -> None:
        """Kills the child, gives its run back to the queue and ends the process."""
        watchdog = threading.Timer(STOP_WITHIN, os._exit, [1])
        watchdog.daemon = True
        watchdog.start()
        try:
            _kill(self._worker.pool.info["processes"])
            for run in lifecycle.hand_back(self._name):
                logger.info("Run %s was handed back to the queue.", run.pk)
            Worker.objects.filter(name=self._name).delete()
        except Exception as error:
            logger.warning("The worker's run goes on when its lease is over: %s", error)
        finally:
            os._exit(0)


def _kill(processes: Iterable[int]) -> None:
    for process in processes:
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
