"""Verbs: label an utterance as the queue asks for it, and take the answer back.

An answer given elsewhere counts for the queue too, so that nobody is asked for what is known.
"""

from __future__ import annotations

from django.db import transaction
from django.db.models import Q

from annotations.labelling import label_answers
from annotations.labelling.finishing import finish, skip, take_back_assignment
from annotations.labelling.giving import NotForThem, take
from annotations.models import Assignment, Label, User, Utterance, Verdict, WorkItem, WorkKind
from annotations.models.queueing import Outcome


def assignment_in(utterance: Utterance, person: User) -> Assignment | None:
    """Return what ``person`` holds about ``utterance``, or None. Audits are decided, not labelled."""
    held = Assignment.objects.held().filter(person=person, item__utterance=utterance)
    to_label = held.exclude(item__kind=WorkKind.AUDIT).select_related("item")
    return to_label.order_by("-item__priority", "id").first()


def answer_waiting(utterance: Utterance, person: User) -> Label | None:
    """Return what ``person`` has answered where the queue still asks others about it, or None."""
    item = Q(item__closed_at=None) | Q(
        item__followed_by__pk__gt=0, item__followed_by__closed_at=None
    )
    done = Assignment.objects.done().filter(item, person=person, item__utterance=utterance)
    assignment = done.exclude(label=None).select_related("label", "item").order_by("-pk").first()
    return assignment.label if assignment else None


def labels_to_compare(item: WorkItem, reader: User) -> list[Label]:
    """Return the labels that an adjudication is about, the older one first, if ``reader`` may see them."""
    if item.kind != WorkKind.ADJUDICATION or item.follows is None:
        return []
    done = Label.objects.filter(assignment__in=item.follows.assignments.done())
    return list(
        done.visible_to(reader)
        .select_related("annotator")
        .order_by("assignment__done_at", "assignment__id")
    )


def answer(
    utterance: Utterance,
    verdict: str,
    form: str,
    by: User,
    version: int,
    seconds: float | None = None,
    reason: str = "",
    assignment: Assignment | None = None,
) -> Label:
    """Store a label (see ``label_answers.label``) and end the person's assignment in the queue with it.

    ``assignment`` is the one that they answer; without it, what they hold about the utterance. The first of
    two independent labels decides nothing; the second one where both say the same. A person is one of
    the two: another answer of theirs replaces their first while the second person has not answered, and
    the same answer once more changes nothing.

    Raises what ``label_answers.label`` raises; nothing is stored then. NoLongerYours is raised, too, where two
    other people are asked.
    """
    text = label_answers.check_answer(verdict, form, reason)
    with transaction.atomic():
        # One answer at a time: the next one sees what this one has done.
        stored = Utterance.with_deleted.select_for_update().get(pk=utterance.pk)
        assignment = _still_theirs(assignment) or assignment_in(stored, by)
        if assignment is None:
            given = answer_waiting(stored, by) or stored.accepted_label
            if given and given.annotator == by and given.says(verdict, text, reason):
                return given
            assignment = _take_unasked(stored, by)
        if assignment is None and verdict != Verdict.SKIP:
            label_answers.require_may_settle(stored, by)
        is_blind = assignment is not None and assignment.item.is_for_two
        row = label_answers.label(
            *(stored, verdict, text or form, by, version, seconds, reason),
            is_blind=is_blind,
            is_asked=assignment is not None,
        )
        if assignment is None:
            return row
        if verdict == Verdict.SKIP:
            skip(assignment)
            return row
        decisive = finish(assignment, row).accept
        if is_blind and decisive is not None:
            label_answers.accept(decisive, by)
            row.refresh_from_db()
        return row


def _still_theirs(assignment: Assignment | None) -> Assignment | None:
    """Return ``assignment`` as it is now; None where it has been answered in the meantime."""
    if assignment is None:
        return None
    stored = Assignment.objects.select_related("item").get(pk=assignment.pk)
    return None if stored.outcome == Outcome.DONE else stored


def _take_unasked(utterance: Utterance, by: User) -> Assignment | None:
    """Return an assignment for an answer that ``by`` gives without having been asked.

    It is their own to an open item, with its answer taken back, or else one to a free item.
    """
    done = Assignment.objects.done().filter(person=by, item__in=WorkItem.objects.open())
    assignment = done.filter(item__utterance=utterance, label__isnull=False).first()
    if assignment is not None and assignment.label is not None:
        take_answer_back(assignment.label, by)
        return Assignment.objects.select_related("item").get(pk=assignment.pk)
    free = WorkItem.objects.open().filter(utterance=utterance).exclude(kind=WorkKind.AUDIT)
    for item in free.order_by("-priority", "id"):
        try:
            return take(by, item)
        except NotForThem:
            continue
    return None


def take_answer_back(label: Label, by: User) -> Utterance:
    """Undo an answer; its person holds the item again.

    Raises Refusal where the answer is somebody else's, and NoLongerYours where others have built on it.
    """
    with transaction.atomic():
        utterance = label_answers.take_back_label(label, by)
        theirs = Assignment.objects.filter(person=label.annotator, item__utterance=label.utterance)
        # A skipped assignment has no label of its own.
        ended = theirs.filter(label=label)
        if label.verdict == Verdict.SKIP:
            ended = theirs.skipped().order_by("-pk")
        if assignment := ended.first():
            take_back_assignment(assignment)
        return utterance
