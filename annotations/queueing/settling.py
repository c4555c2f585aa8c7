"""Verbs for what is decided on a page of its own: end the item about it, and open it again."""

from __future__ import annotations

from django.db import transaction

from annotations.models import User, WorkItem, WorkKind
from annotations.models.queueing import WorkItemQuerySet
from annotations.queueing.enqueuing import Subject, field_of
from annotations.queueing.finishing import finish, take_back
from annotations.queueing.giving import NotForThem, close_item, take


def settle(subject: Subject, kind: WorkKind, by: User) -> None:
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


def unsettle(subject: Subject, kind: WorkKind, by: User) -> None:
    """Open the item again that ``settle`` has ended; ``by`` holds it where they had done it.

    Raises NoLongerYours, a sentence, where others have gone on from it.
    """
    with transaction.atomic():
        rows = _items(subject, kind)
        item = rows.select_for_update().order_by("-closed_at", "-pk").first()
        if item is None or rows.open().exists():
            return
        if done := item.assignments.done().filter(person=by).first():
            take_back(done)
        else:
            item.closed_at, item.places = None, item.people
            item.save(update_fields=["closed_at", "places"])


def _items(subject: Subject, kind: WorkKind) -> WorkItemQuerySet:
    return WorkItem.objects.filter(kind=kind, **{field_of(subject): subject})
