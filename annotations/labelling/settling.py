"""Verbs for what is decided elsewhere: end the item about it, and open it again."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

from django.db import transaction
from django.db.models import Count, Q

from annotations.labelling.enqueuing import ItemSubject, field_of
from annotations.labelling.finishing import finish, take_back_assignment
from annotations.labelling.giving import NotForThem, close_item, take
from annotations.models import Assignment, User, WorkItem, WorkKind
from annotations.models.queueing import OCCUPYING, Outcome, WorkItemQuerySet


def settle(subject: ItemSubject, kind: WorkKind, by: User) -> None:
    """End the open item of ``kind`` about ``subject``, whoever has it, as done by ``by``."""
    with transaction.atomic():
        item = _items(subject, kind).open().select_for_update().first()
        if item is None:
            return
        held = item.assignments.held().filter(person=by).first()
        try:
            finish(held or take(by, item))
        except NotForThem:  # somebody else has it
            close_item(item)


def unsettle(subject: ItemSubject, kind: WorkKind, by: User) -> None:
    """Open the item again that ``settle`` has ended; ``by`` holds it where they had done it.

    Raises NoLongerYours, a sentence, where others have gone on from it.
    """
    with transaction.atomic():
        rows = _items(subject, kind)
        item = rows.select_for_update().order_by("-closed_at", "-pk").first()
        if item is None or rows.open().exists():
            return
        if done := item.assignments.done().filter(person=by).first():
            take_back_assignment(done)
        else:
            item.closed_at, item.places = None, item.people
            item.save(update_fields=["closed_at", "places"])


def _items(subject: ItemSubject, kind: WorkKind) -> WorkItemQuerySet:
    return WorkItem.objects.filter(kind=kind, **{field_of(subject): subject})


def close_items_about(utterances: Sequence[int], at: datetime) -> None:
    """Close the open items about the utterances with these keys, whoever has them."""
    items = WorkItem.objects.open().filter(utterance__in=utterances)
    held = Assignment.objects.held().filter(item__in=items)
    held.update(outcome=Outcome.EXPIRED, leased_until=None)
    items.update(closed_at=at, places=0)


def reopen_items_about(utterances: Sequence[int], closed_at: datetime) -> None:
    """Open the items again that ``close_items_about`` closed at that time; answers that were given stay."""
    items = WorkItem.objects.filter(utterance__in=utterances, closed_at=closed_at)
    occupied = Count("assignments", Q(assignments__outcome__in=OCCUPYING))
    for item in items.annotate(occupied=occupied):  # type: ignore[no-redef]  # declared for readers
        item.closed_at, item.places = None, max(item.people - item.occupied, 0)
        item.save(update_fields=["closed_at", "places"])
