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
