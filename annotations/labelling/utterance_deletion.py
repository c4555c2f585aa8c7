"""Verbs: delete utterances, and restore them with their answers.

A deleted utterance keeps its row and its answers; what people are asked about it is closed, and opened
again when it is restored.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from django.core.exceptions import ValidationError
from django.db import models, transaction
from django.utils import timezone

from annotations.editing.edits import require_version
from annotations.labelling.label_answers import restore_utterance
from annotations.labelling.settling import close_items_about, reopen_items_about
from annotations.models import Label, User, Utterance, UtteranceStatus, World
from annotations.rows.history import (
    ADDED,
    AS_IMPORTED,
    DELETED,
    RESTORED,
    history_of,
    keep_many,
)
from annotations.rows.synchronise import BATCH, batches


def delete_utterance(row: Utterance, by: User, version: int) -> None:
    """Delete ``row``, which ``by`` saw at ``version``.

    Raises Overtaken where it is at another version or was deleted already.
    """
    with transaction.atomic():
        stored = Utterance.with_deleted.select_for_update().get(pk=row.pk)
        require_version(row, None if stored.deleted_at else stored, version, by)
        delete_utterances([stored.pk], by)


def delete_utterances(keys: Sequence[int], by: User, at: datetime | None = None) -> int:
    """Delete those of the utterances with these keys that are not deleted yet. Returns how many.

    ``at`` is the time that marks them as deleted together; now unless given.
    """
    at = at or timezone.now()
    n_deleted = 0
    with transaction.atomic():
        for some in batches(keys, BATCH):
            n_deleted += Utterance.objects.filter(pk__in=some).update(deleted_at=at)
            deleted = Utterance.with_deleted.filter(pk__in=some, deleted_at=at)
            known = history_of(Utterance).filter(id=models.OuterRef("pk"))
            keep_many(deleted.filter(~models.Exists(known)), ADDED, reason=AS_IMPORTED)
            keep_many(deleted, DELETED, by)
            close_items_about(some, at)
    return n_deleted


def restore_utterances(rows: models.QuerySet[Utterance], by: User) -> tuple[int, int]:
    """Restore deleted utterances of one world, with what people were asked about them.

    Returns how many came back, and how many stay deleted because their text is here again.
    """
    rows = rows.filter(deleted_at__isnull=False)
    deleted = list(rows.values_list("pk", "deleted_at", "world"))
    n_restored = 0
    with transaction.atomic():
        if deleted:  # who collects holds the world too, so that no text is added meanwhile
            World.objects.hold().get(pk=deleted[0][2])
        times = {at for _, at, _ in deleted if at}
        for at in sorted(times, reverse=True):  # of equal texts the newest
            for some in batches([key for key, when, _ in deleted if when == at], BATCH):
                n_restored += _restore(some, at, by)
    return n_restored, len(deleted) - n_restored


def _restore(keys: Sequence[int], at: datetime, by: User) -> int:
    same = Utterance.objects.filter(world=models.OuterRef("world"), text=models.OuterRef("text"))
    rows = Utterance.with_deleted.filter(~models.Exists(same), pk__in=keys, deleted_at=at)
    free = list(rows.values_list("pk", flat=True))
    if not free:
        return 0
    Utterance.with_deleted.filter(pk__in=free).update(
        deleted_at=None, version=models.F("version") + 1
    )
    # A predicate may have been renamed in the answer meanwhile.
    others = Label.objects.accepted().exclude(form=models.F("utterance__logical_form"))
    rows = Utterance.objects.filter(pk__in=free, status=UtteranceStatus.LABELLED)
    for row in rows.filter(models.Exists(others.filter(utterance=models.OuterRef("pk")))):
        last = row.accepted_label
        if last is not None and last.form != row.logical_form:
            Utterance.objects.filter(pk=row.pk).update(logical_form=last.form)
    keep_many(Utterance.objects.filter(pk__in=free), ADDED, by, RESTORED)
    reopen_items_about(free, at)
    return len(free)


def restore(entry: Any, by: User) -> models.Model:
    """Make an utterance what the history ``entry`` says; a deleted one comes back with its answers.

    Raises ValidationError where its text was added again meanwhile.
    """
    with transaction.atomic():
        # The world first, as whoever names an entity in the text holds it: nobody waits for the other then.
        World.objects.hold().get(pk=entry.world_id)
        row = Utterance.with_deleted.select_for_update().get(pk=entry.id)
        if row.deleted_at is None:
            return restore_utterance(entry, by)
        n_restored, _ = restore_utterances(Utterance.with_deleted.filter(pk=row.pk), by)
        if not n_restored:
            raise ValidationError("The world has this text again. Delete that utterance first.")
        now = Utterance.objects.get(pk=row.pk)
        is_same = all(getattr(entry, name) == getattr(now, name) for name in now.edited_fields)
        return now if is_same or entry.history_type == DELETED else restore_utterance(entry, by)
