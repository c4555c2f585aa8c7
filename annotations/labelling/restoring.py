"""Verb: restore an earlier version of an utterance, with the answer that it had."""

from __future__ import annotations

from copy import copy

from django.db import models, transaction
from django.utils import timezone

from annotations.labelling.answers import STATUS_AFTER
from annotations.models import Label, User, Utterance
from annotations.rows.history import RESTORED, keep_change

VERDICT_OF = {status: verdict for verdict, status in STATUS_AFTER.items()}


def restore_utterance(entry: models.Model, by: User) -> Utterance:
    """Make an utterance what the history ``entry`` says, as its next version.

    Its form becomes an answer of ``by`` that counts, beside those of others; where it had none, the
    answers that are there count no more.
    """
    wanted = entry.instance
    with transaction.atomic():
        stored = Utterance.objects.select_for_update().get(pk=wanted.pk)
        before = copy(stored)
        for name in Utterance.edited_fields:
            setattr(stored, name, getattr(wanted, name))
        stored.version += 1
        stored.save(update_fields=[*Utterance.edited_fields, "version"])
        if (before.status, before.logical_form) != (stored.status, stored.logical_form):
            _let_answers_follow(stored, wanted.version, by)
        keep_change(before, stored, by, RESTORED)
    return stored


def _let_answers_follow(utterance: Utterance, version: int, by: User) -> None:
    verdict = VERDICT_OF.get(utterance.status)
    if verdict is None:
        utterance.labels.accepted().update(accepted_at=None)
        return
    Label.objects.create(
        utterance=utterance,
        annotator=by,
        verdict=verdict,
        form=utterance.logical_form,
        reason=f"Version {version} was restored.",
        accepted_at=timezone.now(),
    )
