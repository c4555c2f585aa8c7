"""Campaigns, contributors and submissions as programs see them."""

from __future__ import annotations

import pytest

from annotations.campaigns.answering import save_answer
from annotations.campaigns.tasks import begin
from annotations.models import Campaign, Contributor, Scope
from tests.launched_campaigns import small_campaign


@pytest.fixture
def answered(world) -> Campaign:
    campaign = small_campaign(world)
    for name in ("f00d", "cafe"):
        place = begin(campaign, name).submissions.order_by("position").first()
        save_answer(place, f"whatever {name} says", 9)
    return campaign


def test_a_campaign_is_launched_listed_and_closed(call_as, admin, household):
    made = call_as(admin, "post", "worlds/home/campaigns/", {"name": "first", "task_size": 3})
    assert made.status_code == 201
    shown = made.json()
    assert shown["link"].startswith("http://testserver/p/") and not shown["is_over"]
    assert made["Location"].endswith(f"/campaigns/{shown['id']}/")
    (listed,) = call_as(admin, "get", "worlds/home/campaigns/").json()["results"]
    assert listed == shown
    path = f"worlds/home/campaigns/{shown['id']}/"
    assert call_as(admin, "post", f"{path}close/").json()["is_over"]
    assert not call_as(admin, "post", f"{path}reopen/").json()["is_over"]
    assert call_as(admin, "post", f"{path}revoke-link/").json()["link"] == ""
    assert call_as(admin, "post", f"{path}renew-link/").json()["link"] not in ("", shown["link"])
    progress = call_as(admin, "get", f"{path}progress/").json()
    assert progress["forms"] > 10 and progress["seconds_left"] is None


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ({}, 400),
        ({"name": "x", "task_size": 0}, 400),
        ({"name": "x", "task_categories": ["nothing"]}, 400),
        ({"name": "x", "ends_at": "2020-01-01"}, 400),
        ({"name": "x", "owner": 1}, 400),
        ({"name": "x" * 61}, 400),
    ],
)
def test_what_cannot_be_launched_is_said(call_as, admin, household, body, status):
    answer = call_as(admin, "post", "worlds/home/campaigns/", body)
    assert answer.status_code == status, answer.content
    assert not Campaign.objects.exists()


def test_a_name_that_is_taken_is_a_conflict(call_as, admin, household):
    small_campaign(household, name="first")
    answer = call_as(admin, "post", "worlds/home/campaigns/", {"name": "first"})
    assert answer.status_code == 409


def test_submissions_come_with_pseudonyms_alone(call_as, admin, answered):
    rows = call_as(admin, "get", "worlds/home/submissions/", scope=Scope.READ).json()["results"]
    assert {each["contributor"] for each in rows} == {"f00d", "cafe"}
    assert all(each["flags"][0]["code"] == "lost_entity" for each in rows)
    found = call_as(admin, "get", "worlds/home/submissions/?q=cafe").json()["results"]
    assert [each["text"] for each in found] == ["whatever cafe says"]
    none = call_as(admin, "get", "worlds/home/submissions/?status=accepted").json()["results"]
    assert none == []


def test_the_time_that_is_left_is_told_in_seconds(call_as, admin, answered):
    path = f"worlds/home/campaigns/{answered.pk}/progress/"
    progress = call_as(admin, "get", path).json()
    assert progress["rewrites"] == 2 and progress["cost"] is None
    assert progress["seconds_left"] > 0


def test_contributors_are_listed_and_forgotten(call_as, admin, answered):
    rows = call_as(admin, "get", f"worlds/home/contributors/?campaign={answered.pk}").json()
    assert [(each["pseudonym"], each["answers"]) for each in rows["results"]] == [
        ("cafe", 1),
        ("f00d", 1),
    ]
    path = f"worlds/home/contributors/{rows['results'][0]['id']}/forget/"
    assert call_as(admin, "post", path).status_code == 204
    assert Contributor.objects.get().pseudonym == "f00d"


def test_others_than_admins_see_nothing_of_it(call_as, annotator, reviewer, answered):
    for person in (annotator, reviewer):
        for name in ("campaigns", "contributors"):
            assert call_as(person, "get", f"worlds/home/{name}/").status_code == 403


def test_texts_end_and_payment_are_changed_at_a_version(call_as, admin, world):
    campaign = small_campaign(world, thanks="Thanks.", price="1.00")
    path = f"worlds/home/campaigns/{campaign.pk}/"
    tag = call_as(admin, "get", path)["ETag"]
    body = {"thanks": "Thank you.", "price": None, "ends_at": "2099-12-31"}
    answer = call_as(admin, "patch", path, body, if_match=tag)
    assert answer.status_code == 200, answer.content
    shown = answer.json()
    assert (shown["thanks"], shown["price"], shown["version"]) == ("Thank you.", None, 2)
    assert shown["ends_at"] == "2100-01-01T00:00:00Z" and answer["ETag"] != tag
    # What contributors write in the meantime changes no version; what others change does.
    place = begin(campaign, "f00d").submissions.first()
    save_answer(place, "do it", 9)
    assert call_as(admin, "get", path)["ETag"] == answer["ETag"]
    late = call_as(admin, "patch", path, {"thanks": "Late."}, if_match=tag)
    assert late.status_code == 412 and late.json()["current"]["thanks"] == "Thank you."
    refused = call_as(admin, "patch", path, {"consent": "x"}, if_match=answer["ETag"])
    assert refused.status_code == 409


@pytest.mark.parametrize(
    "body",
    [
        *({"task_size": 3}, {"ends_at": "2020-01-01"}, {"return_url": "javascript:alert(1)"}),
        *({"return_url": "http://market.example/"}, {"frame_origins": "market.example"}),
        *({"worker_parameter": "a=b"}, {"minutes": 0}, {"screened_out_url": "https://wiki/"}),
        *({"most_per_hour": 0}, {"price": "-1"}, {"thanks": None}, {"consent": "x" * 8_001}),
    ],
)
def test_what_cannot_be_changed_is_said(call_as, admin, world, body):
    campaign = small_campaign(world)
    path = f"worlds/home/campaigns/{campaign.pk}/"
    assert call_as(admin, "patch", path, body, if_match="*").status_code == 400
    assert Campaign.objects.get().version == 1
