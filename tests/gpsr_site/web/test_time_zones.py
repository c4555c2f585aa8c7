"""Days and hours on pages are those of the reader."""

from __future__ import annotations

import json
from datetime import UTC, datetime, timedelta

import pytest

from annotations.models import Assignment, AuditEntry, Campaign, Utterance
from annotations.models.queueing import Outcome, WorkItem, WorkKind
from parser_service.models import TrainingRun
from tests.launched_campaigns import small_campaign

PAGE = "/w/home/queue/progress/"
LATE = datetime(2026, 11, 26, 23, 30, tzinfo=UTC)


@pytest.fixture
def done_late(sample, annotator, monkeypatch):
    """An item that was done half an hour before midnight UTC, and a clock that is an hour later."""
    item = WorkItem.objects.create(
        world=sample.world, kind=WorkKind.DISPUTED, template=sample.template, priority=1
    )
    Assignment.objects.create(item=item, person=annotator, outcome=Outcome.DONE, done_at=LATE)
    monkeypatch.setattr("django.utils.timezone.now", lambda: LATE.replace(day=27, hour=0))


@pytest.mark.parametrize(
    ("zone", "day"),
    [
        ("", 26),
        ("Asia/Tokyo", 27),
        ("Europe/Berlin", 27),
        ("America/New_York", 26),
        ("Mars/Olympus", 26),
        ("../../etc/passwd", 26),
        ("A" * 5000, 26),
    ],
    ids=lambda value: str(value)[:12],
)
def test_the_days_of_progress_are_those_of_the_reader(zone, day, done_late, anna):
    if zone:
        anna.cookies["time_zone"] = zone
    progress = anna.get(PAGE).context["progress"]
    assert progress.days[0].day == day


def test_the_api_has_utc_whatever_the_cookie_says(done_late, anna):
    anna.cookies["time_zone"] = "Asia/Tokyo"
    answer = anna.get("/api/v1/worlds/home/runs/").json()
    assert answer["results"][0]["queued_at"].endswith("Z")


@pytest.fixture(params=["", "Asia/Tokyo", "America/New_York"])
def zone(request, client):
    """The time zone that the reader's browser tells, if any."""
    if request.param:
        client.cookies["time_zone"] = request.param
    return request.param


DAYS = {"": "2026-11-26", "Asia/Tokyo": "2026-11-27", "America/New_York": "2026-11-26"}
HOURS = {"": "23:30:00 UTC", "Asia/Tokyo": "08:30:00 JST", "America/New_York": "18:30:00 EST"}


def test_times_of_a_list_are_those_of_the_reader(zone, sample, admin, client):
    TrainingRun.objects.update(queued_at=LATE)
    client.force_login(admin)
    page = client.get("/w/home/runs/").content.decode()
    assert f'title="{DAYS[zone]} {HOURS[zone]}"' in page


def test_a_list_is_filtered_by_the_days_of_the_reader(zone, sample, admin, client):
    AuditEntry.objects.create(world=sample.world, world_name="home", who_name="x", what="late")
    AuditEntry.objects.update(at=LATE)
    client.force_login(admin)

    def found(since):
        return client.get("/w/home/log/", {"since": since}).context["listing"].total

    day = int(DAYS[zone][-2:])
    assert [found(f"2026-11-{day + later}") for later in (0, 1)] == [1, 0]


def test_the_last_day_of_a_campaign_is_one_of_whoever_sets_it(zone, sample, admin, client):
    campaign = small_campaign(sample.world, consent="I agree.")
    client.force_login(admin)
    path = f"/w/home/campaigns/{campaign.pk}/"
    form = client.get(f"{path}edit/").context["form"]
    values = {name: value for name, value in form.initial.items() if value is not None}
    client.post(f"{path}edit/", {**values, "ends_at": "2099-06-30"})
    ends = {"": 0, "Asia/Tokyo": -9, "America/New_York": 4}  # hours after midnight UTC
    expected = datetime(2099, 7, 1, tzinfo=UTC) + timedelta(hours=ends[zone])
    assert Campaign.objects.get().ends_at == expected
    assert str(client.get(f"{path}edit/").context["form"].initial["ends_at"]) == "2099-06-30"
    assert "until 1 Jul 2099, 00:00 " in client.get(path).content.decode()


def test_an_export_has_utc_with_its_offset(zone, sample, admin, client):
    Utterance.objects.create(
        world=sample.world, text="bring me tea", anonymized_text="bring me tea"
    )
    Utterance.objects.update(created_at=LATE)
    client.force_login(admin)
    sent = client.get("/api/v1/worlds/home/utterances/export/?as=jsonl").getvalue().decode()
    assert {json.loads(line)["created_at"] for line in sent.splitlines()} == {
        "2026-11-26T23:30:00+00:00"
    }
