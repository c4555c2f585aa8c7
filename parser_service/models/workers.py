"""The processes that carry out background work. The banner reads these rows."""

from __future__ import annotations

import os
import socket
from collections import Counter
from datetime import datetime, timedelta

from django.db import models
from django.utils import timezone

from annotations.models.short_texts import ShortTextField

# The parent process of a worker writes its row every 5 s. Where the database is locked or the machine is
# busy it comes late: a worker of this machine lives while its process does.
ALIVE_FOR = timedelta(seconds=7.5)
ALIVE_ELSEWHERE_FOR = timedelta(seconds=20)
LATE_AT_MOST = timedelta(minutes=2)


class WorkerQuerySet(models.QuerySet["Worker"]):
    def alive(self) -> list[Worker]:
        """Return the workers that live."""
        now = timezone.now()
        return [
            worker
            for worker in self.filter(last_seen__gt=now - LATE_AT_MOST)
            if worker.is_alive(now)
        ]

    def alive_by_queue(self) -> Counter[str]:
        """Count the living workers that serve each queue. Whatever says that work waits for a worker asks here."""
        return Counter(queue for worker in self.alive() for queue in worker.queues)


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
        return str(self.name)

    @property
    def queues(self) -> list[str]:
        return self.queue.split(",")

    def is_alive(self, now: datetime) -> bool:
        """Return whether its row is new, or it runs on this machine and its row is not too old."""
        age = now - self.last_seen
        if age < ALIVE_FOR:
            return True
        if self.host == socket.gethostname():
            return age < LATE_AT_MOST and _runs(self.process_id)
        return age < ALIVE_ELSEWHERE_FOR


def _runs(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass  # of another account
    return True
