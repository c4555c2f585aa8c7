"""Decides when an expired lease means that its holder is lost."""

from __future__ import annotations

import logging
import time
from datetime import datetime

from django.conf import settings
from django.db import connection
from django.utils import timezone

from annotations.background.leasing import EXTEND_EVERY

logger = logging.getLogger(__name__)

LARGEST_STEP = 10 / settings.WORK_TEMPO
GRACE = 2 * EXTEND_EVERY


class LeaseWatch:
    """Tells a timer whether it may take work back.

    After the database was away or locked, or its clock was set (or the machine slept), leases have
    expired although their holders live: for ``GRACE`` seconds nothing is taken from anybody, so that
    they can extend first.
    """

    def __init__(self) -> None:
        self._trusted_from = 0.0
        self._last: tuple[float, datetime] | None = None

    def distrust(self) -> None:
        """Give every holder ``GRACE`` seconds. Called when the database could not be used."""
        self._trusted_from = time.monotonic() + GRACE

    def is_trusted(self) -> bool:
        """Tell whether leases that seem to have expired really have. Called at every tick."""
        clock, now = _database_clock(), time.monotonic()
        if self._last:
            passed = now - self._last[0]
            step = (clock - self._last[1]).total_seconds() - passed
            if abs(step) > LARGEST_STEP:
                logger.warning("The database's clock made a step of %.0f s.", step)
                self.distrust()
            elif passed > GRACE:
                logger.warning("The timer was held up for %.0f s.", passed)
                self.distrust()
        self._last = (now, clock)
        return now >= self._trusted_from


def _database_clock() -> datetime:
    """Return the database's time. SQLite uses this machine's clock."""
    if connection.vendor == "sqlite":
        return timezone.now()
    with connection.cursor() as cursor:
        cursor.execute("SELECT CURRENT_TIMESTAMP")
        now: datetime = cursor.fetchone()[0]
        return now
