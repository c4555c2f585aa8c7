"""Brings claimed work to its end, whatever happens on the way."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable

from django.conf import settings

from annotations.background.failures import failure_sentence
from annotations.background.fencing import Fenced, acknowledge_cancel, fail
from annotations.background.leasing import Lease, Stopped
from annotations.background.outages import (
    OUTAGES,
    DatabaseAway,
    attempts,
    is_outage,
    outage_sentence,
)
from annotations.background.recovery import return_to_queue
from annotations.language.texts import LanguageError
from annotations.models.background import BackgroundWork

logger = logging.getLogger(__name__)

# How long a worker waits for a database to hand its work back; then the timers find the work.
PATIENCE_SECONDS = 900 / settings.WORK_TEMPO


def while_held(
    work: BackgroundWork,
    do: Callable[[Lease], None],
    give_up: Callable[[], None] | None = None,
    explain: Callable[[Exception], str] | None = None,
) -> None:
    """Call ``do``, which ends with ``finish``, while a thread keeps the lease of ``work``.

    ``give_up`` is called where ``do`` does not notice in time that it is to stop; ``explain`` makes
    the sentence of a failure. Whatever happens is in the row; nothing is raised but what ends the
    process. Where the database is away for longer than a lease, the work is handed back once it returns.
    """
    try:
        with Lease(work, give_up) as lease:
            _do(work, lease, do, explain or (lambda error: failure_sentence(error, work.noun)))
    except Fenced as error:
        logger.warning("%s", error)
    except DatabaseAway as error:
        _hand_back_after(work, error)


def _do(
    work: BackgroundWork,
    lease: Lease,
    do: Callable[[Lease], None],
    explain: Callable[[Exception], str],
) -> None:
    try:
        try:
            do(lease)
        except OUTAGES as error:
            if is_outage(error):
                raise DatabaseAway(error, time.monotonic()) from error
            raise
    except (Fenced, DatabaseAway):
        raise
    except Stopped:
        if not lease.is_lost:
            acknowledge_cancel(work)
    except LanguageError as error:
        # A file is not what it should be: who sent it is told, and the log needs no traceback.
        logger.warning("%s was refused: %s", work, error)
        fail(work, explain(error))
    except Exception as error:
        logger.exception("%s failed.", work)
        fail(work, explain(error))


def _hand_back_after(work: BackgroundWork, away: DatabaseAway) -> None:
    """Wait for the database, then queue the work again."""
    logger.warning("%s stops: the database cannot be used: %s", work, away)
    for _ in attempts(PATIENCE_SECONDS):
        try:
            return return_to_queue(work, outage_sentence(away.error, time.monotonic() - away.since))
        except Fenced as error:
            return logger.warning("%s", error)
        except OUTAGES:
            continue
    logger.error("%s could not be handed back; a timer will find it.", work)
