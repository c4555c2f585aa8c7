"""Verbs: give an item to one person, so that nobody else gets the same place in it.

The row of the item is locked and changed in one short transaction; whoever comes at the same time
passes over it (PostgreSQL) or waits for the transaction to end (SQLite).
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime, timedelta
from http import HTTPStatus

from django.db import connection, transaction
from django.db.models import F
from django.utils import timezone

from annotations.labelling.enqueuing import refill
from annotations.language.texts import Refusal
from annotations.models import Assignment, Duty, User, WorkItem, World
from annotations.models.queueing import (
    DONE_ELSEWHERE,
    LEASE,
    AssignmentQuerySet,
    Outcome,
    WorkItemQuerySet,
    WorkKind,
)

# A lease as young as this is not extended, so that looking at an item again waits for no writer.
FRESH = timedelta(minutes=5)
MOST_EXPIRED = 100  # leases that one request takes back


@dataclass(frozen=True, slots=True)
class ItemFilter:
    """Which items somebody asks for: ``labels_only`` are the utterances to label, and those with the keys
    ``without`` are left out."""

    labels_only: bool = False
    without: Collection[int] = ()

    def of_items(self, rows: WorkItemQuerySet) -> WorkItemQuerySet:
        if self.without:
            rows = rows.exclude(utterance__in=self.without)
        if self.labels_only:
            rows = rows.filter(utterance__isnull=False).exclude(kind__in=DONE_ELSEWHERE)
        return rows

    def of_assignments(self, rows: AssignmentQuerySet) -> AssignmentQuerySet:
        if self == ANYTHING:
            return rows
        return rows.filter(item__in=self.of_items(WorkItem.objects.all()))


ANYTHING = ItemFilter()


class NotForThem(Refusal):
    """An item cannot be given to a person; a sentence says why."""

    code = "not_for_them"
    status = HTTPStatus.CONFLICT


def held_item(person: User, world: World, wanted: ItemFilter = ANYTHING) -> Assignment | None:
    """Return the most urgent item that ``person`` holds in ``world``, or None."""
    rows = wanted.of_assignments(
        Assignment.objects.held().filter(person=person, item__world=world)
    ).exclude(leased_until__lt=timezone.now())
    rows = rows.select_related("item__utterance", "item__world")
    return rows.order_by("-item__priority", "id").first()


def next_item(person: User, world: World, wanted: ItemFilter = ANYTHING) -> Assignment | None:
    """Give ``person`` the item they hold, with a fresh lease, or the most urgent one that is free.

    Leases that have expired return before. An empty queue is filled from the rows that call for work.
    Returns None where there is nothing that this person may do.
    """
    if held := _hold_on(person, world, wanted):
        return held
    return_expired(world)
    assignment = _take_free(person, world, wanted)
    if assignment is None and refill(world):
        assignment = _take_free(person, world, wanted)
    return assignment


def next_skipped(person: User, world: World, wanted: ItemFilter = ANYTHING) -> Assignment | None:
    """Give ``person`` the most urgent free item that they have skipped before; None where there is none."""
    for item in skipped_items(person, world, wanted).order_by("-priority", "id"):
        try:
            return take(person, item)
        except NotForThem:
            continue  # taken meanwhile
    return None


def skipped_items(person: User, world: World, wanted: ItemFilter = ANYTHING) -> WorkItemQuerySet:
    """Return the free items that ``person`` has skipped, and may have once more."""
    kinds = kinds_for(person, world)
    rows = wanted.of_items(WorkItem.objects.filter(world=world, kind__in=kinds))
    return rows.skipped_by(person)


def take(person: User, item: WorkItem) -> Assignment:
    """Give ``person`` this very item, although they may have skipped it; what they hold already stays theirs.

    Raises NotForThem where others have taken it, it is done or not for them.
    """
    with transaction.atomic():
        stored = WorkItem.objects.select_for_update().get(pk=item.pk)
        held = stored.assignments.held().filter(person=person).first()
        if held is None:
            return _give(stored, person, timezone.now() + LEASE, None, after_skip=True)
        if held.leased_until is not None:
            held.leased_until = timezone.now() + LEASE
            held.save(update_fields=["leased_until"])
        return held


def assign(item: WorkItem, person: User, by: User) -> Assignment:
    """Give ``item`` to ``person`` without end, as an admin decides. Raises NotForThem."""
    with transaction.atomic():
        return _give(WorkItem.objects.select_for_update().get(pk=item.pk), person, None, by)


def assign_first(rows: WorkItemQuerySet, person: User, count: int, by: User) -> int:
    """Give ``person`` the ``count`` most urgent of the items that they may do. Return how many it were."""
    given = 0
    for item in rows.takeable_by(person).order_by("-priority", "id")[:count]:
        try:
            assign(item, person, by=by)
            given += 1
        except NotForThem:
            continue  # taken meanwhile, or not for this person
    return given


def withdraw(assignment: Assignment) -> None:
    """Take a held item from its person, for others to do; does nothing where they no longer hold it."""
    with transaction.atomic():
        Assignment.objects.filter(pk=assignment.pk).release()


def return_expired(world: World) -> None:
    """Make free what people have kept beyond their leases."""
    expired = Assignment.objects.expired().filter(item__world=world)
    keys = list(expired.values_list("pk", "item_id")[:MOST_EXPIRED])
    for key, item in keys:
        with transaction.atomic():
            rows = _lock_free(WorkItem.objects.filter(pk=item))
            if not rows.exists():
                continue  # somebody else is at it
            if Assignment.objects.expired().filter(pk=key).update(outcome=Outcome.EXPIRED):
                WorkItem.objects.filter(pk=item).update(places=F("places") + 1)


def kinds_for(person: User, world: World) -> list[str]:
    """Return the kinds of work that ``person`` may do: reviewers compare and audit labels, annotators do all."""
    duties = world.duties_of(person)
    if Duty.ANNOTATE in duties:
        return list(WorkKind.values)
    return list(DONE_ELSEWHERE) if Duty.REVIEW in duties else []


def _hold_on(person: User, world: World, wanted: ItemFilter) -> Assignment | None:
    """Return what the person holds, its lease extended."""
    while held := held_item(person, world, wanted):
        if held.item.is_outdated:
            with transaction.atomic():
                close_item(WorkItem.objects.select_for_update().get(pk=held.item_id))
            continue
        now = timezone.now()
        if held.leased_until is None or held.leased_until > now + LEASE - FRESH:
            return held
        held.leased_until = now + LEASE
        if Assignment.objects.held().filter(pk=held.pk).update(leased_until=held.leased_until):
            return held
    return None


def _take_free(person: User, world: World, wanted: ItemFilter) -> Assignment | None:
    kinds = kinds_for(person, world)
    rows = wanted.of_items(WorkItem.objects.filter(world=world, kind__in=kinds))
    with transaction.atomic():
        # What the person has had before comes last.
        while item := _first(rows.takeable_by(person)) or _first(rows.returned_by(person)):
            if not item.is_outdated:
                return _hand_over(item, person, timezone.now() + LEASE, None)
            close_item(item)
    return None


def close_item(item: WorkItem) -> None:
    """Close an item, which is locked: nobody has to do it any more."""
    item.assignments.held().update(outcome=Outcome.EXPIRED, leased_until=None)
    item.places, item.closed_at = 0, timezone.now()
    item.save(update_fields=["places", "closed_at"])


def _first(rows: WorkItemQuerySet) -> WorkItem | None:
    return _lock_free(rows.order_by("-priority", "id")).select_related("utterance").first()


def _lock_free(rows: WorkItemQuerySet) -> WorkItemQuerySet:
    """Lock the rows that nobody else has locked. On SQLite the transaction itself keeps others out."""
    can_skip = connection.features.has_select_for_update_skip_locked
    return rows.select_for_update(skip_locked=True, of=("self",)) if can_skip else rows


def _give(
    item: WorkItem,
    person: User,
    until: datetime | None,
    by: User | None,
    after_skip: bool = False,
) -> Assignment:
    """Give a place of an item that is locked. Raises NotForThem."""
    if not item.is_open:
        raise NotForThem("This is done already.", "already_done")
    if item.kind not in kinds_for(person, item.world):
        raise NotForThem(f"{person} has no role in this world that does this.", "no_role_for_it")
    item.assignments.expired().exclude(person=person).release()
    rows = WorkItem.objects.filter(pk=item.pk)
    if not rows.free().exists():
        is_theirs = item.assignments.held().filter(person=person).exists()
        other = "Somebody is doing this now. Withdraw it from them first."
        said = f"{person} is doing this already." if is_theirs else other
        raise NotForThem(said, "held_by_them" if is_theirs else "done_by_another")
    for_them = rows.takeable_by(person) | rows.returned_by(person)
    if not (rows.not_answered_by(person) if after_skip else for_them).exists():
        said = f"{person} has answered this already, so somebody else has to do it."
        raise NotForThem(said, "already_answered")
    item.refresh_from_db(fields=["places"])
    return _hand_over(item, person, until, by)


def _hand_over(item: WorkItem, person: User, until: datetime | None, by: User | None) -> Assignment:
    """Give a place of an item that is locked."""
    item.places -= 1
    item.save(update_fields=["places"])
    values = {
        "outcome": Outcome.HELD,
        "leased_until": until,
        "assigned_by": by,
        "taken_at": timezone.now(),
    }
    assignment = Assignment(item=item, person=person, **values)
    Assignment.objects.bulk_create(  # one statement, whether or not they have had it before
        [assignment],
        update_conflicts=True,
        unique_fields=["item", "person"],
        update_fields=list(values),
    )
    return assignment
