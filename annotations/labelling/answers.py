"""Verbs: answer what an utterance means, take an answer back, accept one of several.

An utterance is what its accepted answers make it: the one accepted last decides, so that taking an
answer back brings back exactly what was there before it.
"""

from __future__ import annotations

from copy import copy

from django.db import transaction
from django.utils import timezone

from annotations.labelling.form_check import canonical_label
from annotations.models import Label, User, Utterance, UtteranceStatus, Verdict
from annotations.models.corpus import MOST_CHARACTERS
from annotations.rows.history import keep_change

# What an accepted answer makes of an utterance.
STATUS_AFTER = {
    Verdict.FORM: UtteranceStatus.LABELLED,
    Verdict.UNKNOWN: UtteranceStatus.UNKNOWN,
    Verdict.DISPUTE: UtteranceStatus.DISPUTED,
    Verdict.EXCLUDE: UtteranceStatus.EXCLUDED,
}
LONGEST_LOOK = 3_600.0  # seconds; whoever takes longer was away


class AnsweredMeanwhile(Exception):
    """Somebody changed the utterance after the reader had opened it; nothing was saved.

    ``current`` is the utterance as it is now.
    """

    def __init__(self, current: Utterance) -> None:
        label = current.accepted_label
        who = (label and label.annotator) or "Somebody"
        super().__init__(
            f"{who} has changed this utterance in the meantime: it is {current.status} now. "
            "Look at it again, then answer."
        )
        self.current = current


def label(
    utterance: Utterance,
    verdict: str,
    form: str,
    by: User,
    version: int,
    seconds: float | None = None,
    reason: str = "",
    is_blind: bool = False,
) -> Label:
    """Store what ``by`` answers to ``utterance``, which was at ``version`` when they saw it.

    Args:
        form: in any notation, where the verdict is a form.
        seconds: how long the person looked at it; bounded here, because a browser says it.
        reason: why it is disputed, or excluded.
        is_blind: the answer waits to be compared with another person's and decides nothing yet.

    Raises:
        AnsweredMeanwhile: the utterance is at another version; a skip and a blind answer never clash.
        LanguageError, ValueError: the form cannot be read; the verdict lacks something (a sentence).
    """
    text = _check_answer(verdict, form, reason)
    decides = not is_blind and verdict != Verdict.SKIP
    with transaction.atomic():
        stored = _lock(utterance, version if decides else None)
        now = timezone.now()
        row = Label.objects.create(
            utterance=stored,
            annotator=by,
            verdict=verdict,
            form=text,
            reason=" ".join(reason.split())[:MOST_CHARACTERS],
            seconds=None if seconds is None else min(max(seconds, 0.0), LONGEST_LOOK),
            created_at=now,
            accepted_at=now if decides else None,
        )
        if decides:
            _settle(stored, row, by)
    return row


def _check_answer(verdict: str, form: str, reason: str) -> str:
    """Return the canonical form of the answer, "" where it is none. Raises as ``label`` does."""
    text = canonical_label(form) if verdict == Verdict.FORM else ""
    if verdict not in Verdict.values:
        raise ValueError(f"There is no answer {verdict[:20]!r}.")
    if verdict == Verdict.DISPUTE and not reason.strip():
        raise ValueError("Say why you dispute it.")
    return text


def _lock(utterance: Utterance, version: int | None) -> Utterance:
    """Return the locked row. Raises AnsweredMeanwhile where it is not at ``version``, if one is given."""
    stored = Utterance.objects.select_for_update().get(pk=utterance.pk)
    if version is not None and stored.version != version:
        raise AnsweredMeanwhile(stored)
    return stored


def take_back(row: Label, by: User) -> Utterance:
    """Undo an answer of ``by``. Returns the utterance as it was before it.

    Raises ValueError, a sentence, where it is somebody else's or was taken back already.
    """
    with transaction.atomic():
        utterance = Utterance.objects.select_for_update().get(pk=row.utterance_id)
        stored = Label.objects.select_for_update().get(pk=row.pk)
        if stored.annotator_id != by.pk:
            raise ValueError("Only the person who gave an answer takes it back.")
        if stored.taken_back_at is not None:
            raise ValueError("This answer has been taken back already.")
        stored.taken_back_at = timezone.now()
        stored.save(update_fields=["taken_back_at"])
        _settle(utterance, utterance.accepted_label, by)
    return utterance


def accept(row: Label, by: User) -> Utterance:
    """Let a stored answer decide: with what ``by`` has done two people agree on it.

    Raises ValueError, a sentence, where it was taken back or is a skip.
    """
    with transaction.atomic():
        utterance = Utterance.objects.select_for_update().get(pk=row.utterance_id)
        stored = Label.objects.select_for_update().get(pk=row.pk)
        if stored.taken_back_at is not None:
            raise ValueError("This answer has been taken back.")
        if stored.verdict == Verdict.SKIP:
            raise ValueError("A skip is no answer.")
        stored.accepted_at = timezone.now()
        stored.save(update_fields=["accepted_at"])
        _settle(utterance, stored, by)
    return utterance


def _settle(utterance: Utterance, decisive: Label | None, by: User) -> None:
    """Give the locked utterance the status and form of its accepted answer; a new version if they change."""
    status = STATUS_AFTER[Verdict(decisive.verdict)] if decisive else UtteranceStatus.UNLABELLED
    form = decisive.form if decisive else ""
    if (utterance.status, utterance.logical_form) != (status, form):
        before = copy(utterance)
        utterance.status, utterance.logical_form = status, form
        utterance.version += 1
        utterance.save(update_fields=["status", "logical_form", "version"])
        keep_change(before, utterance, by)
