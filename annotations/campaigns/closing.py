"""Verbs: close a campaign and open it again, revoke its link or make a new one, and forget a contributor."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.db import models, transaction
from django.db.models import Q
from django.utils import timezone

from annotations.campaigns.moderation import hand_on, heir_of
from annotations.campaigns.tasks import is_full
from annotations.language.texts import Refusal
from annotations.models import (
    Campaign,
    Comment,
    Contributor,
    Draft,
    Origin,
    Paraphrase,
    Submission,
    Utterance,
)
from annotations.models.campaigns import new_key
from annotations.rows.history import history_of
from annotations.rows.row_kinds import KINDS
from annotations.rows.synchronise import batches

AT_ONCE = 200  # keys in one statement


def close(campaign: Campaign) -> None:
    """Let nobody begin any more. Who has begun may finish for ``GRACE``, unless the link is revoked."""
    if campaign.closed_at is None:
        campaign.closed_at = timezone.now()
        campaign.save(update_fields=["closed_at"])


def reopen(campaign: Campaign) -> None:
    """Undo ``close``.

    Raises:
        Refusal: its last day is over, or it has as many submissions as it wants.
    """
    if campaign.ends_at is not None and campaign.ends_at <= timezone.now():
        said = "Its last day is over. Change the texts and the end, and choose a later day, then open it."
        raise Refusal(said, "time_is_up", HTTPStatus.CONFLICT)
    if is_full(campaign):
        said = "It has as many submissions as it wants. Change the texts and the end, and allow more, then open it."
        raise Refusal(said, "campaign_full", HTTPStatus.CONFLICT)
    campaign.closed_at = None
    campaign.save(update_fields=["closed_at"])


def revoke_link(campaign: Campaign) -> None:
    """Let the link lead nowhere: nobody writes any more, also of those who have begun."""
    campaign.key = ""
    campaign.save(update_fields=["key"])


def renew_link(campaign: Campaign) -> None:
    """Give the campaign another link; the one before leads nowhere any more. Who has begun goes on by the new one."""
    campaign.key = new_key()
    campaign.save(update_fields=["key"])


def forget(contributor: Contributor) -> int:
    """Delete a contributor with all that they wrote, accepted or not, and return how many texts that were.

    What people wrote about it goes as well: its history, comments and drafts. Frozen splits keep their copies: they
    never change.
    """
    with transaction.atomic():
        texts = list(contributor.submissions.answered().values_list("text", flat=True))
        written = {*texts, *contributor.paraphrases.values_list("utterance", flat=True)}
        for row in contributor.submissions.filter(utterance__isnull=False):
            hand_on(row, heir_of(row))  # somebody else said the same
        # A decision that was taken back has left its utterance deleted.
        said_by_others = Submission.objects.filter(
            contributor__campaign__world=contributor.campaign.world_id
        ).exclude(contributor=contributor)
        theirs_alone = written - set(
            said_by_others.filter(text__in=written).values_list("text", flat=True)
        )
        # A reviewer has sent it from a frozen split to the queue.
        was_sent = Q(text__in=theirs_alone, origin=Origin.REVIEW)
        was_theirs = Q(deleted_at__isnull=False, text__in=theirs_alone, origin=Origin.CONTRIBUTOR)
        said = Utterance.with_deleted.filter(
            was_sent | was_theirs | Q(submission__contributor=contributor),
            world=contributor.campaign.world,
        )
        keys = list(said.values_list("pk", flat=True))
        rewritten = history_of(Paraphrase).filter(contributor_id=contributor.pk)
        paraphrases = {
            *contributor.paraphrases.values_list("pk", flat=True),
            *rewritten.values_list("id", flat=True),  # of those that are deleted
        }
        _forget_rows(Utterance.with_deleted, keys)
        _forget_rows(Paraphrase.objects, list(paraphrases))
        contributor.delete()
    return len(texts)


def _forget_rows(rows: models.Manager[Any], keys: list[int]) -> None:
    """Delete rows with what refers to them by their kind and key alone: history, comments and drafts."""
    (kind,) = (each for each in KINDS.values() if each.model is rows.model)
    for some in batches(keys, AT_ONCE):
        rows.filter(pk__in=some).delete()
        history_of(kind.model).filter(id__in=some).delete()
        Comment.objects.filter(kind=kind.name, subject__in=some).delete()
        subjects = Q(subject__in=map(str, some))
        for key in some:
            subjects |= Q(subject__startswith=f"{key}-")
        Draft.objects.filter(subjects, kind=kind.name).delete()
