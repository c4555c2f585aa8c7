"""The kinds of work: training runs, jobs and so on. A worker treats them all alike.

The kinds of jobs are in ``annotations.models.background``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import attrgetter

from django.apps import apps
from django.utils.module_loading import import_string

from annotations.background.fencing import claim
from annotations.models.background import BackgroundWork


def kinds() -> list[type[BackgroundWork]]:
    """Return every model of background work, in the order of the installed apps."""
    return [model for model in apps.get_models() if issubclass(model, BackgroundWork)]


def claim_in_turn(worker: str, queues: Sequence[str]) -> BackgroundWork | None:
    """Claim the oldest work of one of ``queues`` for ``worker``. Return None if nothing waits in any.

    The queue that ``worker`` took its last work from comes last, so that a full queue starves no other.
    """
    of_worker = (kind.objects.filter(worker=worker) for kind in kinds())
    begun = [work for rows in of_worker if (work := rows.order_by("-started_at").first())]
    last = max(begun, key=attrgetter("started_at")).queue if begun else None
    at = queues.index(last) + 1 if last in queues else 0
    claims = (_claim_oldest(worker, queue) for queue in [*queues[at:], *queues[:at]])
    return next(filter(None, claims), None)


def _claim_oldest(worker: str, queue: str) -> BackgroundWork | None:
    while True:
        queued = (kind.objects.queued().filter(queue=queue) for kind in kinds())
        waiting = [work for rows in queued if (work := rows.order_by("queued_at", "id").first())]
        if not waiting:
            return None
        oldest = min(waiting, key=attrgetter("queued_at"))
        if claimed := claim(worker, queue, type(oldest), oldest):
            return claimed


def carry_out(work: BackgroundWork, give_up: Callable[[], None] | None = None) -> None:
    """Bring claimed work to its end. ``give_up`` ends the process where it does not stop in time."""
    import_string(work.carried_out_by)(work, give_up)
