"""Messages that wake workers up. A lost one costs seconds: the workers' timers look for work too."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from datetime import timedelta
from functools import partial
from typing import TYPE_CHECKING

from django.conf import settings
from django.db import transaction
from django.utils import timezone
from django.utils.module_loading import import_string

from annotations.background.kinds import kinds
from annotations.models.background import BackgroundWork

if TYPE_CHECKING:
    from celery import Celery

logger = logging.getLogger(__name__)

TASK = "annotations.work_next"
WAKE_AFTER = timedelta(seconds=15 / settings.WORK_TEMPO)
MESSAGE_LIVES_SECONDS = 60


def queue_app() -> Celery:
    """Return what sends messages and takes them. It is loaded by whoever does: most commands do neither."""
    app: Celery = import_string(settings.QUEUE_APP)
    return app


def message_queue(queue: str) -> str:
    """Return the broker's name of ``queue``."""
    return f"{settings.BROKER_QUEUE_PREFIX}{queue}"


def wake(work: BackgroundWork) -> None:
    """Wake a worker of the work's queue once this transaction is committed."""
    transaction.on_commit(partial(send_wake_up, work.queue))


def send_wake_up(queue: str) -> None:
    """Send one message. Where the broker is away, log a line."""
    try:
        queue_app().send_task(
            TASK,
            args=[queue],
            queue=message_queue(queue),
            expires=MESSAGE_LIVES_SECONDS,
            retry=True,
            retry_policy={"max_retries": 1, "interval_start": 0},
        )
    except _broker_errors() as error:
        logger.warning("No wake-up went to queue %s, a timer will find the work: %s", queue, error)


def _broker_errors() -> tuple[type[Exception], ...]:
    """Return what the library of this broker raises: for a virtual host that is gone, for one."""
    from kombu.exceptions import KombuError, OperationalError

    connection = queue_app().connection_for_write()
    of_library = (*connection.connection_errors, *connection.channel_errors)
    return (KombuError, OperationalError, OSError, *of_library)


def wake_for_next(queues: Sequence[str]) -> None:
    """Send a message if anything waits in one of ``queues``. Which one it names does not matter."""
    for kind in kinds():
        waiting = kind.objects.queued().filter(queue__in=queues)
        if queue := waiting.values_list("queue", flat=True).first():
            return send_wake_up(queue)


def wake_for_forgotten(worker: str, queues: Sequence[str], waited: timedelta = WAKE_AFTER) -> int:
    """Send a message for everything that has been queued for longer than ``waited``. Return how many.

    None while ``worker`` itself is busy: that would only fill a queue that it cannot read.
    """
    if any(model.objects.running().filter(worker=worker).exists() for model in kinds()):
        return 0
    since = timezone.now() - waited
    names = [
        name
        for model in kinds()
        for name in model.objects.queued()
        .filter(queue__in=queues, queued_at__lte=since)
        .values_list("queue", flat=True)
    ]
    for name in names:
        send_wake_up(name)
    return len(names)
