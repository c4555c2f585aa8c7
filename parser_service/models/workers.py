"""The processes that carry out background work. The banner reads these rows."""

from __future__ import annotations

from collections import Counter
from datetime import timedelta

from django.db import models
from django.utils import timezone

from annotations.models.short_texts import ShortTextField

# The parent process of a worker writes its row every 5 s. Pages ask every 2 s: ten seconds after a
# worker's end every page says so.
ALIVE_FOR = timedelta(seconds=7.5)


class WorkerQuerySet(models.QuerySet["Worker"]):
    def alive(self) -> WorkerQuerySet:
        return self.filter(last_seen__gt=timezone.now() - ALIVE_FOR)

    def by_queue(self) -> Counter[str]:
        """Count the workers that serve each queue. Whatever says that work waits for a worker asks here."""
        return Counter(queue for worker in self for queue in worker.queues)


class Worker(models.Model):
    name = ShortTextField(max_length=200, unique=True)
    host = ShortTextField(max_length=200)
    process_id = models.PositiveIntegerField()
    queue = models.CharField(max_length=20)  # those that it serves, with commas between them
    started_at = models.DateTimeField(default=timezone.now)
    last_seen = models.DateTimeField(default=timezone.now)

    objects = WorkerQuerySet.as_manager()

    class Meta:
        ordering = ["name"]

    def __str__(self) -> str:
        return self.name

    @property
    def queues(self) -> list[str]:
        return self.queue.split(",")
