"""How a verb tells a job of its progress, and how its writes are fenced."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from annotations import background
from annotations.models import Job

WRITE_EVERY = 0.5  # seconds


class JobProgress:
    """The progress of a job that this process holds by ``lease``."""

    def __init__(self, job: Job, lease: background.Lease) -> None:
        self.is_concluded = False
        self._job = job
        self._lease = lease
        self._written = 0.0
        self._message = ""

    def report(self, fraction: float, message: str) -> None:
        """Write a new message at once, and a new fraction every half second."""
        self.check()
        now = time.monotonic()
        if message != self._message or now - self._written >= WRITE_EVERY:
            background.record_progress(self._job, fraction, message)
            self._written, self._message = now, message

    def check(self) -> None:
        self._lease.check()

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Open a transaction that only the holder of the job can commit."""
        self.check()
        with background.held(self._job):
            yield

    def conclude(self, report: Mapping[str, Any]) -> None:
        """End the job as succeeded, in the transaction that writes its outcome."""
        background.finish(self._job, report=dict(report))
        self.is_concluded = True
