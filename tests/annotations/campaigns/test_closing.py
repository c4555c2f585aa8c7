from __future__ import annotations

import pytest

from annotations.campaigns.answering import save_answer
from annotations.campaigns.closing import close, forget, renew_link, reopen, revoke_link
from annotations.campaigns.tasks import CampaignOver, begin
from annotations.editing.edits import change
from annotations.labelling.utterance_deletion import delete_utterance
from annotations.models import Campaign, Contributor, Paraphrase, Submission, Utterance
from annotations.models.campaigns import SubmissionStatus
from annotations.rows.history import history_of
from tests.launched_campaigns import small_campaign
from tests.sample_world import make_paraphrase


@pytest.fixture
def campaign(world):
    return small_campaign(world)


def test_a_closed_campaign_can_be_opened_again(campaign):
    close(campaign)
    moment = Campaign.objects.get().closed_at
    close(campaign)
    assert Campaign.objects.get().closed_at == moment
    with pytest.raises(CampaignOver):
        begin(campaign, "one")
    reopen(campaign)
    assert begin(Campaign.objects.get(), "one").submissions.count() == 3


def test_a_link_is_revoked_and_renewed(campaign):
    before = campaign.key
    revoke_link(campaign)
    assert Campaign.objects.for_key(before) is None
    assert Campaign.objects.for_key("") is None
    renew_link(campaign)
    assert Campaign.objects.for_key(before) is None
    assert Campaign.objects.for_key(campaign.key) == campaign
    assert len(campaign.key) > 20


def test_who_is_forgotten_leaves_nothing(campaign, world, admin):
    one, two = begin(campaign, "one"), begin(campaign, "two")
    for contributor in (one, two):
        accepted = make_paraphrase(
            world, grounded_form="go", logical_form="go", contributor=contributor
        )
        said = Utterance.objects.create(
            world=world, text=f"hi {contributor}", anonymized_text=contributor.pseudonym
        )
        first, second, _ = contributor.submissions.order_by("position")
        for place, columns in ((first, {"paraphrase": accepted}), (second, {"utterance": said})):
            save_answer(place, f"{contributor} said so")
            status = SubmissionStatus.ACCEPTED
            Submission.objects.filter(pk=place.pk).update(status=status, **columns)
        change(accepted, {"status": "disputed"}, admin, accepted.version)
        delete_utterance(said, admin, said.version)
    assert forget(one) == 2
    assert list(Contributor.objects.all()) == [two]
    assert Submission.objects.count() == 3
    assert Paraphrase.objects.get().contributor == two
    assert Utterance.with_deleted.get().anonymized_text == "two"
    histories = (history_of(Paraphrase).all(), history_of(Utterance).all())
    assert {row.contributor_id for row in histories[0]} == {two.pk}
    assert {row.text for row in histories[1]} == {"hi two"}
