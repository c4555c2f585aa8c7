"""The kinds of work. App configs register them; a worker treats them all alike."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

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


def claim_next(worker: str, queue: str) -> BackgroundWork | None:
    """Claim the work of any kind that has waited longest in ``queue``. Return None if there is none."""
    while waiting := [oldest for kind in kinds() if (oldest := _oldest(kind, queue))]:
        oldest = min(waiting, key=lambda work: work.queued_at)
        if claimed := claim(worker, queue, type(oldest), oldest):
            return claimed
    return None


def _oldest(kind: Kind, queue: str) -> BackgroundWork | None:
    waiting = kind.model.objects.queued().filter(queue=queue)
    return waiting.order_by("queued_at", "id").first()


def carry_out(work: BackgroundWork, give_up: Callable[[], None] | None = None) -> None:
    """Bring claimed work to its end. ``give_up`` ends the process where it does not stop in time."""
    import_string(_KINDS[type(work)].dotted)(work, give_up)
