"""What admins see of campaigns, and what they do with them."""

from __future__ import annotations

from datetime import timedelta

import pytest
from django.utils import timezone

from annotations.campaigns.answering import save_answer
from annotations.campaigns.tasks import begin
from annotations.models import AuditEntry, Campaign, Contributor
from annotations.models.campaigns import GRACE
from annotations.web.campaigns.campaign_forms import CampaignChangeForm, CampaignForm
from tests.launched_campaigns import small_campaign


def sent(world, **values):
    """What the form holds as it is shown, with other ``values``."""
    form = CampaignForm(world, initial={"name": "Campaign 1"})
    given = {**{name: form[name].value() for name in form.fields}, **values}
    return {name: each for name, each in given.items() if each is not None and each is not False}


def page(client, path: str = "") -> str:
    answer = client.get(f"/w/home/campaigns/{path}")
    assert answer.status_code == 200
    return answer.content.decode()


def test_without_campaigns_the_list_says_what_to_do(adam):
    assert "No campaigns yet" in page(adam)
    assert "/w/home/campaigns/new/" in page(adam)


def test_the_form_as_it_is_launches_a_campaign(adam, household):
    answer = adam.post("/w/home/campaigns/new/", sent(household, launch="1"))
    campaign = Campaign.objects.get()
    assert answer.url == f"/w/home/campaigns/{campaign.pk}/"
    assert (campaign.task_size, campaign.free_commands, campaign.target_per_form) == (12, 2, 10)
    assert not campaign.allows_model_help and "research" in campaign.consent
    assert campaign.prompts.count() > 50
    assert AuditEntry.objects.get().what == "launch a campaign"
    shown = page(adam, f"{campaign.pk}/")
    assert f"http://testserver/p/{campaign.key}/" in shown
    assert "0 of" in shown


def test_a_preview_stores_nothing(adam, household):
    answer = adam.post("/w/home/campaigns/new/", sent(household, preview="1"))
    assert answer.status_code == 200
    report = answer.context["report"]
    assert report["count"] > 50 and 5 < len(report["prompts"]) <= 8
    assert not Campaign.objects.exists()


@pytest.mark.parametrize(
    ("values", "field"),
    [
        ({"name": ""}, "name"),
        ({"task_size": "0"}, "task_size"),
        ({"task_categories": ["nothing"]}, "task_categories"),
        ({"ends_at": "2020-01-01"}, "ends_at"),
        ({"ends_at": "9999-12-31"}, "ends_at"),
        ({"return_url": "javascript:alert(1)"}, "return_url"),
        ({"return_url": "https://me:secret@market.example/"}, "return_url"),
        ({"return_url": "https://market.example/" + "x" * 500}, "return_url"),
        ({"screened_out_url": "http://10.0.0.7/"}, "screened_out_url"),
        ({"frame_origins": "https://*.example"}, "frame_origins"),
        ({"worker_parameter": "a b"}, "worker_parameter"),
        ({"price": "-1"}, "price"),
    ],
)
def test_what_cannot_be_is_said_beside_its_field(adam, household, values, field):
    answer = adam.post("/w/home/campaigns/new/", sent(household, launch="1", **values))
    assert answer.status_code == 422
    assert field in answer.context["form"].errors
    assert not Campaign.objects.exists()


def test_a_name_is_taken_once(adam, household):
    for status in (302, 422):
        answer = adam.post("/w/home/campaigns/new/", sent(household, launch="1", name="first"))
        assert answer.status_code == status
    assert "name" in answer.context["form"].errors


def test_a_world_without_commands_has_nothing_to_ask_for(adam, world):
    answer = adam.post("/w/home/campaigns/new/", sent(world, launch="1"))
    assert answer.status_code == 422
    assert answer.context["form"].non_field_errors()


def test_the_last_day_counts_as_a_whole(adam, household):
    today = timezone.now().date()
    values = sent(household, launch="1", ends_at=today.isoformat())
    adam.post("/w/home/campaigns/new/", values)
    assert timezone.now() < Campaign.objects.get().ends_at <= timezone.now() + timedelta(days=1)


def test_buttons_close_open_and_change_the_link(adam, world):
    campaign = small_campaign(world)
    key = campaign.key

    def act(step: str) -> Campaign:
        answer = adam.post(f"/w/home/campaigns/{campaign.pk}/act/", {"step": step})
        assert answer.url == f"/w/home/campaigns/{campaign.pk}/"
        return Campaign.objects.get()

    assert act("close").closed_at
    assert "Open again" in page(adam, f"{campaign.pk}/")
    assert not act("open").closed_at
    assert act("revoke").key == ""
    assert "The link was revoked" in page(adam, f"{campaign.pk}/")
    assert act("renew").key not in ("", key)
    assert act("nothing").key


def test_the_page_shows_who_contributes_and_how_far_it_is(adam, world):
    campaign = small_campaign(world, price="1.50", currency="EUR")
    contributor = begin(campaign, "f00d")
    for place in contributor.submissions.all():
        save_answer(place, place.prompt.shown if place.prompt else "water the plants", 9)
    shown = page(adam, f"{campaign.pk}/")
    assert "f00d" in shown and "0.00 EUR" in shown
    assert "2 rewrites and 1 free command." in " ".join(shown.split())
    assert "Rewrites" in page(adam, f"{campaign.pk}/state/")
    assert "first" in page(adam)


def test_a_contributor_is_forgotten_after_a_question(adam, world):
    campaign = small_campaign(world)
    contributor = begin(campaign, "f00d")
    save_answer(contributor.submissions.first(), "do it")
    path = f"/w/home/contributors/{contributor.pk}/forget/"
    assert "cannot be undone" in adam.get(path).content.decode()
    assert Contributor.objects.exists()
    assert adam.post(path).url == f"/w/home/campaigns/{campaign.pk}/"
    assert not Contributor.objects.exists()


def changed(client, campaign, **values):
    """Post the form that changes a campaign as it is shown, with other ``values``."""
    form = CampaignChangeForm(Campaign.objects.get(pk=campaign.pk))
    given = {name: form[name].value() for name in form.fields} | values
    given = {name: each for name, each in given.items() if each is not None}
    return client.post(f"/w/home/campaigns/{campaign.pk}/edit/", given)


def test_texts_end_and_payment_are_changed(adam, world):
    campaign = small_campaign(world, consent="I agree.", price="1.00")
    shown = page(adam, f"{campaign.pk}/edit/")
    assert "I agree." in shown and "readonly" not in shown and "Task categories" not in shown
    day = (timezone.now() + timedelta(days=3)).date()
    answer = changed(
        adam, campaign, thanks="a\r\nb", ends_at=day.isoformat(), price="2.50", most_per_hour=20
    )
    assert answer.url == f"/w/home/campaigns/{campaign.pk}/"
    stored = Campaign.objects.get()
    assert (stored.thanks, str(stored.price), stored.most_per_hour) == ("a\nb", "2.50", 20)
    assert stored.ends_at.date() == day + timedelta(days=1)
    assert (stored.consent, stored.version) == ("I agree.", 2)
    entry = AuditEntry.objects.get()
    assert entry.what == "change a campaign"
    assert entry.subject == "first: thanks, ends_at, most_per_hour, price"


def test_an_end_that_is_over_may_stay(adam, world):
    over = timezone.now() - timedelta(days=3)
    campaign = small_campaign(world, ends_at=over)
    assert changed(adam, campaign, thanks="Thanks.").status_code == 302
    assert Campaign.objects.get().ends_at == over
    assert changed(adam, campaign, ends_at="2020-01-01").status_code == 422


def test_a_consent_that_was_given_is_shown_and_stays(adam, world):
    campaign = small_campaign(world, consent="I\nagree.")
    begin(campaign, "f00d")
    assert "readonly" in page(adam, f"{campaign.pk}/edit/")
    assert changed(adam, campaign, consent="I\r\nagree.", thanks="Thanks.").status_code == 302
    answer = changed(adam, campaign, consent="Another.")
    assert answer.status_code == 409 and "consent" in answer.context["form"].errors
    assert Campaign.objects.get().consent == "I\nagree."


def test_who_was_slower_compares_and_saves_again(adam, world):
    campaign = small_campaign(world, thanks="as it was")
    assert changed(adam, campaign, thanks="theirs").status_code == 302
    answer = changed(adam, campaign, thanks="mine", version=1)
    shown = answer.content.decode()
    assert answer.status_code == 412 and "theirs" in shown and "mine" in shown
    assert answer.context["form"]["version"].value() == 2
    assert Campaign.objects.get().thanks == "theirs"
    assert changed(adam, campaign, thanks="mine", version=2).status_code == 302


def test_the_page_says_until_when_those_who_have_begun_may_finish(adam, world):
    campaign = small_campaign(world)
    assert "may finish until" not in page(adam, f"{campaign.pk}/")
    adam.post(f"/w/home/campaigns/{campaign.pk}/act/", {"step": "close"})
    assert "may finish until" in page(adam, f"{campaign.pk}/")
    Campaign.objects.update(closed_at=timezone.now() - GRACE)
    assert "may finish until" not in page(adam, f"{campaign.pk}/")


def test_a_link_of_this_computer_is_told_so_and_what_is_missing_too(launched, adam):
    campaign = launched()
    address = f"/w/home/campaigns/{campaign.pk}/"
    page = adam.get(address, headers={"host": "localhost"}).content.decode()
    assert "ALLOWED_HOSTS" in page and f"{address}edit/" in page
    assert "?visit=preview" in page
    missing = page.count(f"{address}edit/")
    type(campaign).objects.update(run_by="Lab", contact="a@lab.example")
    page = adam.get(address).content.decode()
    assert "ALLOWED_HOSTS" not in page and page.count(f"{address}edit/") == missing - 1
