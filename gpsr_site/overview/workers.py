"""The state of the workers, as the top bar and the banner of every page show it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Set
from dataclasses import dataclass

from django.db.models import Count

from annotations.background import kinds
from annotations.models.background import Queue, Status
from parser_service.models import Worker
from parser_service.parsers.registry import parsers

# Each of them needs a living worker, whether or not something waits there.
NEEDED = frozenset({Queue.QUICK, *(Queue(entry.queue) for entry in parsers().values())})
TAKEN_BY = {Queue.CPU: "training worker", Queue.GPU: "GPU worker", Queue.QUICK: "quick worker"}


@dataclass(frozen=True, slots=True)
class Workers:
    """The queues that living workers serve, and the work that runs and that waits (by queue), over all
    worlds; ``noun`` is what to call it."""

    served: Set[str]
    running: int
    waiting: Mapping[str, int]
    noun: str

    @property
    def missing(self) -> list[str]:
        """The queues that no living worker serves although one should."""
        wanted = NEEDED | {queue for queue, count in self.waiting.items() if count}
        return [queue for queue in TAKEN_BY if queue in wanted - self.served]

    @property
    def is_alive(self) -> bool:
        return not self.missing

    @property
    def is_work_left(self) -> bool:
        """Whether work waits, or would wait, for a worker that is not there, whatever others do meanwhile."""
        return not self.served or any(self.waiting.get(queue) for queue in self.missing)

    @property
    def _missing_worker(self) -> str:
        """What to call the missing worker, first one that work waits for."""
        if not self.served:
            return "worker"
        queue = max(self.missing, key=lambda queue: bool(self.waiting.get(queue)))
        return TAKEN_BY[Queue(queue)]

    @property
    def _left_behind(self) -> int:
        """How much begun work waits because no worker lives."""
        return 0 if self.served else self.running

    @property
    def summary(self) -> str:
        """The state in two or three words, for the top bar."""
        queued = sum(self.waiting.values()) + self._left_behind
        waiting = f", {queued} waiting" if queued else ""
        if self.missing:
            return f"No {self._missing_worker}{waiting}"
        return f"{self.running} running{waiting}" if self.running else f"Worker idle{waiting}"

    @property
    def headline(self) -> str:
        """Which worker is missing, for the banner; empty where all is well."""
        return f"No {self._missing_worker} is running." if self.missing else ""

    @property
    def sentence(self) -> str:
        """How much work waits for the missing worker; empty where all is well."""
        if not self.missing:
            return ""
        waiting = sum(self.waiting.get(queue, 0) for queue in self.missing) + self._left_behind
        if not waiting:
            return "A run that is started now would wait."
        return f"{waiting} {self.noun}{' waits' if waiting == 1 else 's wait'} for one."


def workers_now() -> Workers:
    """Return the state now: one query for the workers and one per kind of work."""
    counts: Counter[tuple[str, str]] = Counter()
    nouns = set()
    for kind in kinds():
        rows = kind.objects.active().order_by().values_list("status", "queue")
        for status, queue, count in rows.annotate(count=Count("pk")):
            counts[status, queue] += count
            nouns.add(kind.noun)
    return Workers(
        served=set(Worker.objects.alive_by_queue()),
        running=sum(count for (status, _), count in counts.items() if status == Status.RUNNING),
        waiting={queue: n for (status, queue), n in counts.items() if status == Status.QUEUED},
        noun=nouns.pop() if len(nouns) == 1 else "job",
    )
