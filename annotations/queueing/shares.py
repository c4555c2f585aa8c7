"""Which share of the items two people do, blind."""

from __future__ import annotations

from django.db import transaction
from django.db.models import Q

from annotations.models import WorkItem, WorkShare, World
from annotations.models.queueing import DRAWS, WorkKind

# An adjudication compares two labels already, and a dispute is settled by one person.
DOUBLE_KINDS = (
    WorkKind.UNLABELLED,
    WorkKind.LOW_CONFIDENCE,
    WorkKind.DISAGREEMENT,
    WorkKind.REQUESTED,
)


def shares_of(world: World) -> dict[str, int]:
    """Return the percentage of items that two people do, for each kind that may have one."""
    rows = dict(world.work_shares.values_list("kind", "percent"))
    return {kind: rows.get(kind, 0) for kind in DOUBLE_KINDS}


def people_for(kind: str, subject: str, draw: int, shares: dict[str, int]) -> int:
    """Return how many people are to do an item: labels of utterances alone can be compared."""
    is_double = subject == "utterance" and draw < shares.get(kind, 0) * DRAWS // 100
    return 2 if is_double else 1


@transaction.atomic
def set_share(world: World, kind: WorkKind, percent: int) -> None:
    """Let two people do ``percent`` of the items of ``kind``, those included that nobody has touched.

    Raises ValueError for a kind that one person does, and for what is no percentage.
    """
    if kind not in DOUBLE_KINDS or not 0 <= percent <= 100:
        raise ValueError("Choose a share from 0 to 100 % of a kind that two people can do.")
    WorkShare.objects.update_or_create(world=world, kind=kind, defaults={"percent": percent})
    rows = WorkItem.objects.filter(world=world, kind=kind, utterance__isnull=False)
    untouched = rows.untouched()
    is_double = Q(draw__lt=percent * DRAWS // 100)
    untouched.filter(is_double, people=1).update(people=2, places=2)
    untouched.filter(~is_double, people=2).update(people=1, places=1)
