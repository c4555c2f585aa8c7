"""Verbs: end one person's assignment, and decide what two independent labels amount to."""

from __future__ import annotations

from dataclasses import dataclass

from django.db import transaction
from django.db.models import F, Q
from django.utils import timezone

from annotations.labelling.label_answers import NoLongerYours
from annotations.language.forms import equivalent, read_template_form
from annotations.models import Assignment, Label, WorkItem
from annotations.models.corpus import Verdict
from annotations.models.queueing import (
    FREE_AGAIN,
    LEASE,
    OCCUPYING,
    PRIORITIES,
    Outcome,
    WorkKind,
)


@dataclass(frozen=True, slots=True)
class ItemDecision:
    """What a finished assignment to ``item`` means: ``accept`` is the label that counts from now on.

    It is None while a second person is to answer, and where two labels differ: then ``follow_up`` is
    the item in which a third person compares them.
    """

    item: WorkItem
    accept: Label | None = None
    follow_up: WorkItem | None = None


def finish(assignment: Assignment, label: Label | None = None) -> ItemDecision:
    """End an assignment with the ``label`` they gave, if it is about an utterance.

    A lease that has expired does no harm while nobody else has taken the place.

    Raises NoLongerYours, a sentence, where the item is closed or somebody else has the place.
    """
    with transaction.atomic():
        item, stored = _lock(assignment)
        if stored.outcome in FREE_AGAIN and item.is_open and item.places > 0:
            item.places -= 1  # they came back before anybody else
        elif stored.outcome == Outcome.DONE:
            said = "You have done this already. Take your answer back to change it."
            raise NoLongerYours(said, "already_done")
        elif stored.outcome != Outcome.HELD:
            raise _why_lost(item, stored)
        stored.outcome, stored.label = Outcome.DONE, label
        stored.done_at, stored.leased_until = timezone.now(), None
        stored.save(update_fields=["outcome", "label", "done_at", "leased_until"])
        done = [stored]
        if item.people > 1:
            rows = item.assignments.done().select_related("label")
            done = list(rows.order_by("done_at", "id"))
        is_complete = len(done) >= item.people
        item.closed_at = timezone.now() if is_complete else None
        item.save(update_fields=["places", "closed_at"])
        labels = [each.label for each in done if each.label is not None]
        return _decide(item, labels) if is_complete else ItemDecision(item)


def _why_lost(item: WorkItem, stored: Assignment) -> NoLongerYours:
    """Return why an answer to an item comes too late: another person, or a closed item. It is never oneself."""
    others = item.assignments.filter(outcome__in=OCCUPYING).exclude(person=stored.person)
    if item.is_open and others.exists():
        said = "Somebody else is doing this now. Your answer was not counted."
        return NoLongerYours(said, "done_by_another")
    said = "This item is no longer open. Your answer was not counted."
    return NoLongerYours(said, "already_done")


def skip(assignment: Assignment) -> None:
    """End an assignment without an answer: others may have it, and they do not get it again."""
    _free(assignment, Outcome.SKIPPED)


def give_back(assignment: Assignment) -> None:
    """Return an item for now: others may have it, and its person gets it again once nothing else is left."""
    _free(assignment, Outcome.RETURNED)


def take_back_assignment(assignment: Assignment) -> None:
    """Reopen a finished assignment, whose label its person takes back; they hold the item again.

    Raises NoLongerYours, a sentence, where others have built on the answer already.
    """
    with transaction.atomic():
        item, stored = _lock(assignment)
        others = item.assignments.filter(outcome__in=OCCUPYING).exclude(pk=stored.pk).count()
        is_answered = stored.outcome in (Outcome.DONE, Outcome.SKIPPED)
        if not is_answered or others >= item.people:
            raise NoLongerYours("There is no answer of yours here to take back.", "no_answer_here")
        _remove_what_came_after(item)
        item.closed_at, item.places = None, item.people - others - 1
        item.save(update_fields=["places", "closed_at"])
        stored.outcome, stored.label, stored.done_at = Outcome.HELD, None, None
        stored.leased_until = timezone.now() + LEASE
        stored.save(update_fields=["outcome", "label", "done_at", "leased_until"])


def _remove_what_came_after(item: WorkItem) -> None:
    """Remove the item that compares the answer, and one that asks for it anew, unless somebody is at it."""
    same = Q(
        kind=item.kind,
        utterance=item.utterance_id,
        template=item.template_id,
        paraphrase=item.paraphrase_id,
        closed_at=None,
    )
    later = WorkItem.objects.select_for_update().filter(Q(follows=item) | same).exclude(pk=item.pk)
    for each in later:
        if each.assignments.filter(outcome__in=OCCUPYING).exists():
            raise NoLongerYours("Somebody has gone on from this answer already.", "gone_on_from")
        each.delete()


def _lock(assignment: Assignment) -> tuple[WorkItem, Assignment]:
    item = WorkItem.objects.select_for_update().get(pk=assignment.item_id)
    return item, Assignment.objects.select_related("label").get(pk=assignment.pk)


def _free(assignment: Assignment, outcome: Outcome) -> None:
    with transaction.atomic():
        item, stored = _lock(assignment)
        if stored.outcome == Outcome.HELD:
            WorkItem.objects.filter(pk=item.pk).update(places=F("places") + 1)
            stored.outcome, stored.leased_until = outcome, None
            stored.save(update_fields=["outcome", "leased_until"])


def _decide(item: WorkItem, labels: list[Label]) -> ItemDecision:
    if not labels:
        return ItemDecision(item)
    if not all(agree(labels[0], other) for other in labels[1:]):
        names = " and ".join(str(each.annotator or "somebody") for each in labels)
        reason = f"{names} gave different answers. Choose one, or write another."
        return ItemDecision(item, follow_up=_follow(item, WorkKind.ADJUDICATION, reason))
    if labels[0].verdict != Verdict.DISPUTE or item.kind == WorkKind.DISPUTED:
        return ItemDecision(item, labels[-1])
    reason = f"Disputed by {labels[0].annotator}: {labels[0].reason}"
    return ItemDecision(item, labels[-1], _follow(item, WorkKind.DISPUTED, reason))


def agree(first: Label, second: Label) -> bool:
    """Return whether two labels say the same; the order of conjuncts does not matter."""
    if first.verdict != second.verdict:
        return False
    if first.form == second.form or first.verdict != Verdict.FORM:
        return True
    return equivalent(read_template_form(first.form), read_template_form(second.form))


def _follow(item: WorkItem, kind: WorkKind, reason: str) -> WorkItem:
    """Add the item that follows from ``item``; an open one of that kind about the subject is used."""
    follow_up, _ = WorkItem.objects.get_or_create(
        utterance=item.utterance,
        kind=kind,
        closed_at=None,
        defaults={
            "world": item.world,
            "title": item.title,
            "reason": reason,
            "priority": PRIORITIES[kind],
            "follows": item,
        },
    )
    return follow_up
