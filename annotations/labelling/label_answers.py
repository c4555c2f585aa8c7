"""Verbs: answer what an utterance means, take an answer back, accept one of several, restore an earlier version.

An utterance is what its accepted answers make it: the one accepted last decides, so that taking an
answer back brings back exactly what was there before it.
"""

from __future__ import annotations

from copy import copy
from http import HTTPStatus

from django.db import transaction
from django.utils import timezone

from annotations.editing.edits import say_who
from annotations.labelling.form_check import canonical_label
from annotations.language.texts import Refusal
from annotations.models import Label, User, Utterance, UtteranceStatus, Verdict, WorkItem
from annotations.models.corpus import MOST_CHARACTERS
from annotations.models.editing import HistoryEntry
from annotations.rows.history import RESTORED, keep_change

# What an accepted answer makes of an utterance.
STATUS_AFTER = {
    Verdict.FORM: UtteranceStatus.LABELLED,
    Verdict.UNKNOWN: UtteranceStatus.UNKNOWN,
    Verdict.DISPUTE: UtteranceStatus.DISPUTED,
    Verdict.EXCLUDE: UtteranceStatus.EXCLUDED,
}
LONGEST_LOOK = 3_600.0  # seconds; whoever takes longer was away
VERDICT_OF = {status: verdict for verdict, status in STATUS_AFTER.items()}


class AnsweredMeanwhile(Refusal):
    """Somebody changed the utterance after the reader had opened it; nothing was saved.

    ``current`` is the utterance as it is now.
    """

    code = "answered_meanwhile"
    status = HTTPStatus.CONFLICT

    def __init__(self, current: Utterance, reader: User) -> None:
        label = current.accepted_label
        if current.deleted_at:
            sentence = (
                "Somebody has deleted this utterance in the meantime. “Deleted utterances” below the "
                "list brings it back."
            )
        else:
            who = say_who(label.annotator if label else None, reader, "changed this utterance")
            sentence = f"{who} It is {current.status} now. Look at it again, then answer."
        super().__init__(sentence)
        self.current = current


class NoLongerYours(Refusal):
    """It is for others to answer, and not for this person (any more); a sentence says why."""

    code = "no_longer_yours"
    status = HTTPStatus.CONFLICT


def require_may_settle(utterance: Utterance, by: User) -> None:
    """Raise NoLongerYours where ``by``, whom nobody has asked, may not say alone what ``utterance`` means.

    That is so while two people are asked independently of each other, and where somebody else is asked
    about what ``by`` has answered. The utterance is locked.
    """
    _require_other_party(utterance, by)
    if WorkItem.objects.open().for_two().filter(utterance=utterance).exists():
        raise NoLongerYours(
            "Two people are labelling this independently of each other. Wait until both have answered."
        )


def _require_other_party(utterance: Utterance, by: User) -> None:
    """Raise NoLongerYours where others are still asked about what ``by`` has answered."""
    items = WorkItem.objects.open().filter(utterance=utterance)
    if items.exclude(pk__in=items.not_answered_by(by)).exists():
        raise NoLongerYours(
            "You have answered this, and somebody else is asked about it now. Take your answer back to change it."
        )


def label(
    utterance: Utterance,
    verdict: str,
    form: str,
    by: User,
    version: int,
    seconds: float | None = None,
    reason: str = "",
    is_blind: bool = False,
    is_asked: bool = False,
) -> Label:
    """Store what ``by`` answers to ``utterance``, which was at ``version`` when they saw it.

    Args:
        form: in any notation, where the verdict is a form.
        seconds: how long the person looked at it; bounded here, because a browser says it.
        reason: why it is disputed, or excluded.
        is_blind: the answer waits to be compared with another person's and decides nothing yet.
        is_asked: the work queue asks ``by`` to settle it, whoever else has answered.

    Raises:
        AnsweredMeanwhile: the utterance is at another version; a skip and a blind answer never clash.
        NoLongerYours: others are still asked about what ``by`` has answered before.
        LanguageError: the form cannot be read.
        Refusal: the verdict lacks something.
    """
    text = check_answer(verdict, form, reason)
    decides = not is_blind and verdict != Verdict.SKIP
    with transaction.atomic():
        stored = hold_utterance(utterance, version if decides else None, by)
        if decides and not is_asked:
            _require_other_party(stored, by)
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
            settle(stored, row, by)
    return row


def check_answer(verdict: str, form: str, reason: str) -> str:
    """Return the canonical form of the answer, "" where it is none. Raises as ``label`` does."""
    text = canonical_label(form) if verdict == Verdict.FORM else ""
    if verdict not in Verdict.values:
        raise Refusal(f"There is no answer {verdict[:20]!r}.", "no_such_answer")
    if verdict == Verdict.DISPUTE and not reason.strip():
        raise Refusal("Say why you dispute it.", "no_reason")
    return text


def hold_utterance(utterance: Utterance, version: int | None, by: User) -> Utterance:
    """Return the row, which nobody else changes until the transaction is over.

    Raises AnsweredMeanwhile where it was deleted, or is not at ``version``, which ``by`` has seen, if one
    is given.
    """
    stored = Utterance.with_deleted.select_for_update().get(pk=utterance.pk)
    if stored.deleted_at or (version is not None and stored.version != version):
        raise AnsweredMeanwhile(stored, by)
    return stored


def take_back_label(row: Label, by: User) -> Utterance:
    """Undo an answer of ``by``. Returns the utterance as it was before it.

    Raises Refusal where it is somebody else's or was taken back already.
    """
    with transaction.atomic():
        utterance = Utterance.with_deleted.select_for_update().get(pk=row.utterance_id)
        stored = Label.objects.select_for_update().get(pk=row.pk)
        if stored.annotator_id != by.pk:
            said = "Only the person who gave an answer takes it back."
            raise Refusal(said, "not_their_answer", HTTPStatus.CONFLICT)
        if stored.taken_back_at is not None:
            said = "This answer has been taken back already."
            raise Refusal(said, "already_taken_back", HTTPStatus.CONFLICT)
        stored.taken_back_at = timezone.now()
        stored.save(update_fields=["taken_back_at"])
        settle(utterance, utterance.accepted_label, by)
    return utterance


def accept(row: Label, by: User) -> Utterance:
    """Let a stored answer decide: with what ``by`` has done two people agree on it.

    Raises Refusal where it was taken back or is a skip.
    """
    with transaction.atomic():
        utterance = Utterance.with_deleted.select_for_update().get(pk=row.utterance_id)
        stored = Label.objects.select_for_update().get(pk=row.pk)
        if stored.taken_back_at is not None:
            raise Refusal("This answer has been taken back.", "already_taken_back")
        if stored.verdict == Verdict.SKIP:
            raise Refusal("A skip is no answer.", "skip_is_no_answer")
        stored.accepted_at = timezone.now()
        stored.save(update_fields=["accepted_at"])
        settle(utterance, stored, by)
    return utterance


def settle(utterance: Utterance, decisive: Label | None, by: User) -> None:
    """Give the locked utterance the status and form of its accepted answer; a new version if they change."""
    status = STATUS_AFTER[Verdict(decisive.verdict)] if decisive else UtteranceStatus.UNLABELLED
    form = decisive.form if decisive else ""
    if (utterance.status, utterance.logical_form) != (status, form):
        before = copy(utterance)
        utterance.status, utterance.logical_form = status, form
        utterance.version += 1
        utterance.save(update_fields=["status", "logical_form", "version"])
        keep_change(before, utterance, by)


def restore_utterance(entry: HistoryEntry, by: User) -> Utterance:
    """Make an utterance what the history ``entry`` says, as its next version.

    Its form becomes an answer of ``by`` that counts, beside those of others; where it had none, the
    answers that are there count no more.

    Raises NoLongerYours where ``by`` may not say alone what it means.
    """
    wanted = entry.instance
    with transaction.atomic():
        stored = Utterance.with_deleted.select_for_update().get(pk=wanted.pk)
        if (stored.status, stored.logical_form) != (wanted.status, wanted.logical_form):
            require_may_settle(stored, by)
        before = copy(stored)
        for name in Utterance.edited_fields:
            setattr(stored, name, getattr(wanted, name))
        stored.version += 1
        stored.save(update_fields=[*Utterance.edited_fields, "version"])
        if (before.status, before.logical_form) != (stored.status, stored.logical_form):
            if verdict := VERDICT_OF.get(UtteranceStatus(stored.status)):
                Label.objects.create(
                    utterance=stored,
                    annotator=by,
                    verdict=verdict,
                    form=stored.logical_form,
                    reason=f"Version {wanted.version} was restored.",
                    accepted_at=timezone.now(),
                )
            else:
                stored.labels.accepted().update(accepted_at=None)
        keep_change(before, stored, by, RESTORED)
    return stored
