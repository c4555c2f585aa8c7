"""Verbs: label an utterance as the queue asks for it, and take the answer back.

An answer given elsewhere counts for the queue too, so that nobody is asked for what is known.
"""

from __future__ import annotations

from django.db import transaction

from annotations import labelling
from annotations.models import Assignment, Label, User, Utterance, Verdict, WorkItem, WorkKind
from annotations.queueing.finishing import finish, skip, take_back
from annotations.queueing.giving import NotForThem, take


def part_in(utterance: Utterance, person: User) -> Assignment | None:
    """Return what ``person`` holds about ``utterance``, or None. Audits are decided, not labelled."""
    held = Assignment.objects.held().filter(person=person, item__utterance=utterance)
    to_label = held.exclude(item__kind=WorkKind.AUDIT).select_related("item")
    return to_label.order_by("-item__priority", "id").first()


def answer(
    utterance: Utterance,
    verdict: str,
    form: str,
    by: User,
    version: int,
    seconds: float | None = None,
    reason: str = "",
    part: Assignment | None = None,
) -> Label:
    """Store a label (see ``labelling.label``) and end the person's part in the queue with it.

    ``part`` is the one that they answer; without it, what they hold about the utterance. The first of
    two independent labels decides nothing; the second one where both say the same.

    Raises what ``labelling.label`` raises; nothing is stored then.
    """
    with transaction.atomic():
        part = part or part_in(utterance, by) or _take_part(utterance, by)
        is_blind = part is not None and part.item.is_for_two
        row = labelling.label(
            utterance, verdict, form, by, version, seconds, reason, is_blind=is_blind
        )
        if part is None:
            return row
        if verdict == Verdict.SKIP:
            skip(part)
            return row
        decisive = finish(part, row).accept
        if is_blind and decisive is not None:
            labelling.accept(decisive, by)
        return row


def take_answer_back(label: Label, by: User) -> Utterance:
    """Undo an answer; its person holds the item again.

    Raises ValueError, a sentence, where it is somebody else's, and NoLongerYours where others have gone
    on from it.
    """
    with transaction.atomic():
        utterance = labelling.take_back(label, by)
        if part := _part_of(label):
            take_back(part)
        return utterance


def _part_of(label: Label) -> Assignment | None:
    """Return the finished part that a label ended; a skipped one has no label of its own."""
    theirs = Assignment.objects.filter(person=label.annotator, item__utterance=label.utterance)
    if label.verdict == Verdict.SKIP:
        return theirs.skipped().order_by("-pk").first()
    return theirs.filter(label=label).first()


def _take_part(utterance: Utterance, by: User) -> Assignment | None:
    """Take the free item about an utterance that somebody answers without having been asked."""
    free = WorkItem.objects.free().filter(utterance=utterance).exclude(kind=WorkKind.AUDIT)
    for item in free.order_by("-priority", "id"):
        try:
            return take(by, item)
        except NotForThem:
            continue
    return None
