from __future__ import annotations

import pytest

from annotations.campaigns.changing import CampaignChanged, change_campaign
from annotations.campaigns.model_rewrites import ModelSettings, model_contributor
from annotations.campaigns.tasks import begin
from annotations.language.texts.errors import Refusal
from annotations.models import Campaign
from tests.launched_campaigns import small_campaign


@pytest.fixture
def campaign(world) -> Campaign:
    return small_campaign(world, consent="I agree.", thanks="Thanks.")


def test_what_changed_is_named_and_is_the_next_version(campaign):
    values = {"thanks": "Thank you.", "price": 2, "consent": "I agree."}
    assert change_campaign(campaign, values, 1) == ("thanks", "price")
    stored = Campaign.objects.get()
    assert (stored.thanks, stored.price, stored.version) == ("Thank you.", 2, 2)
    assert change_campaign(campaign, {"thanks": "Thank you."}, 2) == ()
    assert Campaign.objects.get().version == 2


def test_of_two_who_read_the_same_version_one_saves(campaign):
    change_campaign(campaign, {"thanks": "one"}, 1)
    with pytest.raises(CampaignChanged) as clash:
        change_campaign(campaign, {"thanks": "two"}, 1)
    assert clash.value.current.thanks == "one"
    assert Campaign.objects.get().thanks == "one"


def test_a_consent_stays_once_somebody_has_agreed_to_it(campaign):
    model_contributor(campaign, ModelSettings("some model", "{command}"))  # agrees to nothing
    change_campaign(campaign, {"consent": "Anew."}, 1)
    begin(campaign, "one")
    with pytest.raises(Refusal) as refusal:
        change_campaign(campaign, {"consent": "Other.", "thanks": "Other."}, 2)
    assert refusal.value.code == "consent_was_given"
    stored = Campaign.objects.get()
    assert (stored.consent, stored.thanks) == ("Anew.", "Thanks.")
    change_campaign(campaign, {"consent": "Anew.", "thanks": "Other."}, 2)


def test_prompts_and_the_size_of_a_task_stay(campaign):
    assert change_campaign(campaign, {"task_size": 9, "key": "x", "name": "other"}, 1) == ()
    assert Campaign.objects.get().task_size == 2
