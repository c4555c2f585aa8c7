"""Verb: change the texts, the end and the payment of a campaign that was launched."""

from __future__ import annotations

from collections.abc import Mapping
from http import HTTPStatus
from typing import Any

from django.db import transaction

from annotations.language.texts import Refusal
from annotations.models import Campaign
from annotations.models.campaigns import ContributorKind

# What may change while people contribute, in the groups of the page. Prompts and the size of a task stay: they are the
# same for everybody.
TEXTS = ("introduction", "examples", "consent", "thanks")
END = ("ends_at", "most_submissions", "most_per_hour", "price")
ABOUT = ("currency", "minutes", "run_by", "contact")
MARKET = (
    *("completion_code", "return_url", "worker_parameter", "assignment_parameter"),
    *("frame_origins", "screening_question", "screened_out_code", "screened_out_url"),
)
CHANGEABLE = (*TEXTS, *END, *ABOUT, *MARKET)


class CampaignChanged(Refusal):
    """Somebody else changed the campaign after it was read; nothing was stored."""

    code = "overtaken"
    status = HTTPStatus.PRECONDITION_FAILED

    def __init__(self, current: Campaign) -> None:
        super().__init__(
            "Somebody has changed this campaign in the meantime. Compare, then save again."
        )
        self.current = current


def has_consents(campaign: Campaign) -> bool:
    """Return whether somebody has agreed to the consent: it stays as they read it."""
    return campaign.contributors.filter(kind=ContributorKind.PERSON).exists()


def change_campaign(campaign: Campaign, values: Mapping[str, Any], version: int) -> tuple[str, ...]:
    """Store ``values`` of ``CHANGEABLE`` fields as the next version. Return the names of those that were others before.

    Raises:
        CampaignChanged: it is not at ``version`` any more.
        Refusal: somebody has agreed to the consent that is to change.
    """
    with transaction.atomic():
        held = Campaign.objects.select_for_update().get(pk=campaign.pk)
        if held.version != version:
            raise CampaignChanged(held)
        changed = [
            name for name in CHANGEABLE if name in values and getattr(held, name) != values[name]
        ]
        if "consent" in changed and has_consents(held):
            said = "Somebody has agreed to this text already. Launch another campaign for another consent."
            raise Refusal(said, "consent_was_given", HTTPStatus.CONFLICT)
        if changed:
            for name in changed:
                setattr(held, name, values[name])
            held.version += 1
            held.save(update_fields=[*changed, "version"])
    return tuple(changed)
