"""Verbs: close a campaign and open it again, revoke its link or make a new one, and forget a contributor."""

from __future__ import annotations

from http import HTTPStatus

from django.db import transaction
from django.db.models import Q
from django.utils import timezone

from annotations.campaigns.moderation import hand_on, heir_of
from annotations.campaigns.tasks import is_full
from annotations.language.errors import Refusal
from annotations.models import Campaign, Contributor, Origin, Paraphrase, Submission, Utterance
from annotations.models.campaigns import SubmissionKind, new_key
from annotations.rows.history import history_of


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

    Its history goes as well, so that nobody brings it back. Frozen splits keep their copies: they never change.
    """
    with transaction.atomic():
        texts = list(contributor.submissions.answered().values_list("text", flat=True))
        for row in contributor.submissions.filter(utterance__isnull=False):
            hand_on(row, heir_of(row))  # somebody else said the same
        # A decision that was taken back has left its utterance deleted.
        said_by_others = Submission.objects.filter(
            contributor__campaign__world=contributor.campaign.world_id, kind=SubmissionKind.FREE
        ).exclude(contributor=contributor)
        theirs_alone = set(texts) - set(
            said_by_others.filter(text__in=texts).values_list("text", flat=True)
        )
        was_theirs = Q(deleted_at__isnull=False, text__in=theirs_alone, origin=Origin.CONTRIBUTOR)
        said = Utterance.with_deleted.filter(
            was_theirs | Q(submission__contributor=contributor), world=contributor.campaign.world
        )
        keys = list(said.values_list("pk", flat=True))
        Utterance.with_deleted.filter(pk__in=keys).delete()
        contributor.paraphrases.all().delete()
        history_of(Utterance).filter(id__in=keys).delete()
        history_of(Paraphrase).filter(contributor_id=contributor.pk).delete()
        contributor.delete()
    return len(texts)
