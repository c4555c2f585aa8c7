"""What all work that a worker carries out has in common: training runs, imports, generation.

``annotations.background`` alone writes these columns.
"""

from __future__ import annotations

from datetime import timedelta
from typing import ClassVar

from django.conf import settings
from django.db import models
from django.db.models.functions import Now
from django.utils import timezone

LEASE = timedelta(seconds=45 / settings.WORK_TEMPO)


class Status(models.TextChoices):
    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"
    LOST = "lost"


ENDED = (Status.SUCCEEDED, Status.FAILED, Status.CANCELLED, Status.LOST)


class Queue(models.TextChoices):
    """Which worker takes it: one that trains on the processor or on a GPU, or the one for short work."""

    CPU = "cpu"
    GPU = "gpu"
    QUICK = "quick"


def status_choices() -> list[tuple[str, str]]:
    return Status.choices


def queue_choices() -> list[tuple[str, str]]:
    return Queue.choices


class WorkQuerySet(models.QuerySet):
    """Named sets of background work. A kind's own query set extends it."""

    def queued(self):
        return self.filter(status=Status.QUEUED)

    def running(self):
        return self.filter(status=Status.RUNNING)

    def succeeded(self):
        return self.filter(status=Status.SUCCEEDED)

    def active(self):
        """Return what is queued or running."""
        return self.exclude(status__in=ENDED)

    def expired(self):
        """Return the running rows whose worker has not extended its lease, by the database's clock.

        A lease that ends far ahead is from before that clock was set back.
        """
        is_over = models.Q(lease_until__lt=Now()) | models.Q(lease_until__gt=Now() + 2 * LEASE)
        return self.running().filter(is_over)


class BackgroundWork(models.Model):
    """One piece of work. ``attempt`` is the fencing token of whoever carries it out now; ``resumes``
    counts how often a worker was lost with it (a worker that stops in good order does not count).

    ``noun`` is what messages call it; ``resumption`` what happens to it after an interruption.
    """

    noun: ClassVar[str] = "job"
    resumption: ClassVar[str] = "starting over"

    queue = models.CharField(max_length=8, choices=queue_choices, default=Queue.CPU)
    status = models.CharField(max_length=12, choices=status_choices, default=Status.QUEUED)
    attempt = models.PositiveIntegerField(default=0)
    resumes = models.PositiveSmallIntegerField(default=0)
    lease_until = models.DateTimeField(null=True, blank=True)
    worker = models.CharField(max_length=200, blank=True)
    cancel_requested = models.BooleanField(default=False)
    progress = models.FloatField(default=0)
    activity = models.CharField(max_length=200, blank=True)
    failure = models.TextField(blank=True)
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL
    )
    queued_at = models.DateTimeField(default=timezone.now)
    started_at = models.DateTimeField(null=True, blank=True)
    finished_at = models.DateTimeField(null=True, blank=True)

    objects = WorkQuerySet.as_manager()

    class Meta:
        abstract = True

    def __str__(self) -> str:
        return f"{self.noun} {self.pk}"

    @property
    def is_ended(self) -> bool:
        return self.status in ENDED

    @property
    def progress_percent(self) -> float:
        return 100 * self.progress

    def note(self, message: str) -> None:
        """Add a line to the log of this work. A kind that keeps no log drops it."""
