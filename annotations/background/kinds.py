"""The kinds of work. App configs register them; a worker treats them all alike."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from operator import attrgetter

from django.utils.module_loading import import_string

from annotations.background.fencing import claim
from annotations.models.background import BackgroundWork


@dataclass(frozen=True, slots=True)
class Kind:
    """A model and the dotted path of its ``carry_out(work, give_up)``, loaded in a worker's child only."""

    model: type[BackgroundWork]
    dotted: str


_KINDS: dict[type[BackgroundWork], Kind] = {}


def register(model: type[BackgroundWork], dotted: str) -> None:
    """Let workers carry out the work of ``model``. Called once, by an app config."""
    _KINDS[model] = Kind(model, dotted)


def kinds() -> tuple[Kind, ...]:
    """Return every kind of work, in the order of the installed apps."""
    return tuple(_KINDS.values())


def claim_in_turn(worker: str, queues: Sequence[str]) -> BackgroundWork | None:
    """Claim the oldest work of one of ``queues`` for ``worker``. Return None if nothing waits in any.

    The queue that ``worker`` took its last work from comes last, so that a full queue starves no other.
    """
    of_worker = (kind.model.objects.filter(worker=worker) for kind in kinds())
    begun = [work for rows in of_worker if (work := rows.order_by("-started_at").first())]
    last = max(begun, key=attrgetter("started_at")).queue if begun else None
    at = queues.index(last) + 1 if last in queues else 0
    claims = (_claim_oldest(worker, queue) for queue in [*queues[at:], *queues[:at]])
    return next(filter(None, claims), None)


def _claim_oldest(worker: str, queue: str) -> BackgroundWork | None:
    while True:
        queued = (kind.model.objects.queued().filter(queue=queue) for kind in kinds())
        waiting = [work for rows in queued if (work := rows.order_by("queued_at", "id").first())]
        if not waiting:
            return None
        oldest = min(waiting, key=attrgetter("queued_at"))
        if claimed := claim(worker, queue, type(oldest), oldest):
            return claimed


def carry_out(work: BackgroundWork, give_up: Callable[[], None] | None = None) -> None:
    """Bring claimed work to its end. ``give_up`` ends the process where it does not stop in time."""
    import_string(_KINDS[type(work)].dotted)(work, give_up)
