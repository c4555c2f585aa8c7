"""Files of campaigns by pages and routes: tasks down, results up, exports."""

from __future__ import annotations

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations import background
from annotations.background.carrying_out_jobs import carry_out
from annotations.campaigns.answering import save_answer
from annotations.campaigns.campaign_files import MOST_TASKS
from annotations.campaigns.moderation import accept
from annotations.campaigns.tasks import begin
from annotations.models import Campaign, Job, Scope, Submission
from tests.crowd_tables import results
from tests.launched_campaigns import small_campaign

SAID = {"1": "head into the study", "2": "look for an apple", "free": "water the plants please"}
PAGE = "/w/home/campaigns/results/"


@pytest.fixture(autouse=True)
def own_folder(settings, tmp_path):
    settings.VAR_DIR = tmp_path


def table(rows=(SAID,)) -> SimpleUploadedFile:
    return SimpleUploadedFile("results.csv", results(rows))


def work() -> None:
    carry_out(background.claim("a worker", "quick", Job))


def test_results_are_checked_confirmed_and_moderated(world, adam):
    sent = adam.post(PAGE, {"file": table(), "name": "market"})
    job = Job.objects.get()
    assert sent.status_code == 302 and sent["Location"] == f"/jobs/{job.pk}/"
    work()
    page = adam.get(f"/jobs/{job.pk}/")
    assert page.context["report"]["is_waiting"] and not Submission.objects.exists()
    assert "head into the study" in page.content.decode()
    answered = adam.post(f"/jobs/{job.pk}/answer/")
    work()
    done = adam.get(answered["Location"])
    campaign = Campaign.objects.get()
    link = f"/w/home/submissions/?status=pending&amp;campaign={campaign.pk}"
    assert link in done.content.decode()
    waiting = adam.get(link.replace("&amp;", "&"))
    assert waiting.context["listing"].total == 3
    assert "head into the study" not in adam.get(f"/jobs/{job.pk}/").content.decode()


@pytest.mark.parametrize(
    "fields",
    [
        {"name": ""},
        {"name": "first"},
        {"name": "x" * 61},
        {"campaign": "999"},
        {"campaign": "0x"},
        {"name": "second", "encoding": "klingon"},
        {"name": "second", "file": ""},
    ],
)
def test_what_is_missing_is_said(world, adam, fields):
    small_campaign(world)
    answer = adam.post(PAGE, {"file": table(), **fields})
    assert answer.status_code == 422 and answer.context["form"].errors
    assert not Job.objects.exists()


def test_a_campaign_is_chosen_or_named_not_both(world, adam):
    campaign = small_campaign(world)
    answer = adam.post(PAGE, {"file": table(), "campaign": campaign.pk, "name": "second"})
    assert list(answer.context["form"].errors) == ["name"]
    chosen = adam.get(f"{PAGE}?campaign={campaign.pk}").context["form"]["campaign"]
    assert chosen.value() == str(campaign.pk)


def test_a_campaign_of_another_world_is_none(world, other_world, adam):
    elsewhere = small_campaign(other_world)
    assert adam.post(PAGE, {"file": table(), "campaign": elsewhere.pk}).status_code == 422


def test_programs_send_results_and_answer(call_as, admin, world):
    sent = call_as(
        admin, "post", "worlds/home/campaigns/results/", files={"file": table(), "name": "market"}
    )
    assert sent.status_code == 202
    key = sent.json()["job"]["id"]
    assert sent["Location"].endswith(f"/worlds/home/jobs/{key}/")
    work()
    checked = call_as(admin, "get", f"worlds/home/jobs/{key}/").json()
    assert checked["is_waiting_for_answer"] and checked["report"]["counts"]["rewrites"] == 2
    confirmed = call_as(admin, "post", f"worlds/home/jobs/{key}/answer/")
    assert confirmed.status_code == 202
    work()
    assert Submission.objects.awaiting_moderation().count() == 3


def test_what_programs_send_wrongly_is_refused(call_as, admin, world):
    path = "worlds/home/campaigns/results/"
    assert call_as(admin, "post", path, files={"file": table()}).status_code == 400
    assert call_as(admin, "post", path, files={"name": "market"}).status_code == 400
    small_campaign(world, name="market")
    taken = call_as(admin, "post", path, files={"file": table(), "name": "market"})
    assert taken.status_code == 409


def test_a_task_file_is_streamed_and_bounded(call_as, admin, world):
    path = f"worlds/home/campaigns/{small_campaign(world).pk}/tasks/"
    answer = call_as(admin, "get", f"{path}?tasks=3", scope=Scope.READ)
    assert answer.streaming and answer["Content-Type"].startswith("text/csv")
    assert len(b"".join(answer.streaming_content).splitlines()) == 4
    for number in (0, MOST_TASKS + 1, "many"):
        assert call_as(admin, "get", f"{path}?tasks={number}").status_code == 400


def test_submissions_and_triples_are_downloaded(call_as, admin, world):
    campaign = small_campaign(world)
    first, second, _ = begin(campaign, "f00d").submissions.order_by("position")
    save_answer(first, "get it", 9)
    save_answer(second, "count them", 9)
    accept([first], admin)
    path = f"worlds/home/submissions/export/?campaign={campaign.pk}"
    every = b"".join(call_as(admin, "get", path).streaming_content).decode()
    accepted = b"".join(call_as(admin, "get", f"{path}&status=accepted").streaming_content).decode()
    assert "get it" in every and "count them" in every
    assert "get it" in accepted and "count them" not in accepted
    triples = call_as(admin, "get", f"worlds/home/campaigns/{campaign.pk}/triples/")
    assert b"".join(triples.streaming_content).decode().splitlines() == [
        "get it",
        first.prompt.prompt,
        first.prompt.grounded_form,
    ]


def test_the_page_of_a_campaign_leads_to_its_files(world, adam):
    campaign = small_campaign(world)
    page = adam.get(f"/w/home/campaigns/{campaign.pk}/").content.decode()
    below = f"/api/v1/worlds/home/campaigns/{campaign.pk}"
    for address in (
        f'action="{below}/tasks/"',
        f'href="{below}/triples/"',
        f'href="/api/v1/worlds/home/submissions/export/?campaign={campaign.pk}"',
        f'href="{PAGE}?campaign={campaign.pk}"',
    ):
        assert address in page
