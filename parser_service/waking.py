"""Messages that wake workers up. A lost one costs seconds: the workers' timers look for runs too."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from datetime import timedelta
from functools import partial

from celery import current_app
from django.conf import settings
from django.db import transaction
from django.utils import timezone
from kombu.exceptions import KombuError, OperationalError

from parser_service.models import TrainingRun

logger = logging.getLogger(__name__)

TASK = "parser_service.train_next"
WAKE_AFTER = timedelta(seconds=15 / settings.WORK_TEMPO)
MESSAGE_LIVES_SECONDS = 60


def message_queue(queue: str) -> str:
    """What the broker calls ``queue``."""
    return f"{settings.BROKER_QUEUE_PREFIX}{queue}"


def wake(run: TrainingRun) -> None:
    """Tells a worker of the run's queue, once this transaction is over, that there is work."""
    transaction.on_commit(partial(send_wake_up, run.queue))


def send_wake_up(queue: str) -> None:
    """Sends one message; where the broker is away, a line in the log and no more."""
    try:
        current_app.send_task(
            TASK,
            args=[queue],
            queue=message_queue(queue),
            expires=MESSAGE_LIVES_SECONDS,
            retry=True,
            retry_policy={"max_retries": 1, "interval_start": 0},
        )
    except (KombuError, OperationalError, OSError) as error:
        logger.warning("No wake-up went to queue %s, a timer will find the run: %s", queue, error)


def wake_for_next(queue: str) -> None:
    """Sends a message if anything waits in ``queue``."""
    if TrainingRun.objects.queued().filter(queue=queue).exists():
        send_wake_up(queue)


def wake_for_forgotten(worker: str, queues: Sequence[str], waited: timedelta = WAKE_AFTER) -> int:
    """Sends a message for each run that has been queued for longer than ``waited``; how many.

    None while ``worker`` itself has a run: that would only fill a queue that it cannot read.
    """
    if TrainingRun.objects.running().filter(worker=worker).exists():
        return 0
    forgotten = TrainingRun.objects.queued().filter(
        queue__in=queues, queued_at__lte=timezone.now() - waited
    )
    names = list(forgotten.values_list("queue", flat=True))
    for name in names:
        send_wake_up(name)
    return len(names)
