"""Days and hours on pages are those of the reader."""

from __future__ import annotations

from datetime import UTC, datetime

import pytest

from annotations.models import Assignment
from annotations.models.queueing import Outcome, WorkItem, WorkKind

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
