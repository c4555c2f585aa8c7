"""/api/v1/worlds/<w>/events/: what has ended, told once to each who asks on by the last id."""

from __future__ import annotations

import json
from datetime import timedelta
from itertools import chain

import pytest
from django.utils import timezone
from hypothesis import given
from hypothesis import strategies as st

from annotations.background.endings import (
    LONGEST_MARK,
    MOST_AT_ONCE,
    MOST_TOLD,
    OVERLAP,
    Ending,
    Mark,
)
from annotations.campaigns.closing import close, reopen
from annotations.models import Campaign, Job, JobKind
from annotations.models.background import Status
from parser_service.models import TrainingRun
from tests.parser_service.made_up import make_split
from tests.parser_service.requests import ask


def read_events(text: str) -> tuple[list[tuple[str, dict]], str]:
    """Return name and data of each event, and the last id, as the standard of server-sent events reads them."""
    events: list[tuple[str, dict]] = []
    name = data = last = ""
    for line in text.split("\n"):
        field, _, value = line.partition(": ")
        if field == "event":
            name = value
        elif field == "data":
            data = value
        elif field == "id":
            last = value
        elif not line and data:
            events.append((name, json.loads(data)))
            name = data = ""
    return events, last


@pytest.fixture
def listen(call_as, annotator, world):
    """A function: what has ended since the last time that it was called."""
    last = ""

    def get() -> list[tuple[str, dict]]:
        nonlocal last
        headers = {"last_event_id": last} if last else {}
        answer = call_as(annotator, "get", "worlds/home/events/", **headers)
        assert answer.status_code == 200
        assert answer["Content-Type"].startswith("text/event-stream")
        events, newest = read_events(answer.content.decode())
        last = newest or last
        return events

    return get


def end_job(world, status: str = Status.SUCCEEDED, at=None, **values) -> Job:
    return Job.objects.create(
        world=world,
        world_name=world.name,
        kind=values.pop("kind", JobKind.IMPORT_PAIRS),
        status=status,
        finished_at=at or timezone.now(),
        **values,
    )


def test_an_import_a_run_and_a_campaign_are_told_once(listen, world, launched):
    campaign = launched()
    run = ask(make_split(world))
    assert listen() == []
    assert listen() == []
    job = end_job(world, Status.FAILED, failure="The file is empty.")
    TrainingRun.objects.filter(pk=run.pk).update(
        status=Status.SUCCEEDED, finished_at=timezone.now()
    )
    close(campaign)
    told = [(name, data["id"], data["status"]) for name, data in listen()]
    assert told == [
        ("job", job.pk, "failed"),
        ("run", run.pk, "succeeded"),
        ("campaign", campaign.pk, "closed"),
    ]
    assert listen() == []


def test_an_event_says_why_and_where(listen, call_as, annotator, world):
    listen()
    end_job(world, Status.FAILED, failure="The file\nis empty.")
    ((_, data),) = listen()
    assert data["failure"] == "The file\nis empty."
    shown = call_as(annotator, "get", data["address"].removeprefix("/api/v1/")).json()
    assert (shown["id"], shown["status"]) == (data["id"], "failed")


def test_what_is_seen_late_is_told_all_the_same(listen, world):
    listen()
    end_job(world)
    assert len(listen()) == 1
    late = end_job(world, at=timezone.now() - OVERLAP / 2)
    assert [data["id"] for _, data in listen()] == [late.pk]
    assert listen() == []


def test_what_ended_before_somebody_listened_is_not_told(listen, world):
    end_job(world)
    end_job(world, at=timezone.now() - timedelta(days=3))
    assert listen() == []
    assert listen() == []


def test_what_ends_again_is_told_again(listen, world, launched):
    campaign = launched()
    listen()
    for _ in range(2):
        close(campaign)
        assert [name for name, _ in listen()] == ["campaign"]
        reopen(campaign)
    Campaign.objects.filter(pk=campaign.pk).update(ends_at=timezone.now())
    assert [data["status"] for _, data in listen()] == ["closed"]


def test_an_import_that_asks_is_waiting(listen, world):
    listen()
    end_job(world, report={"is_waiting": True})
    assert [data["status"] for _, data in listen()] == ["waiting"]


def test_much_that_ends_at_once_comes_in_parts_and_nothing_is_lost(listen, world):
    listen()
    now = timezone.now()
    jobs = [end_job(world, at=now + timedelta(milliseconds=n)) for n in range(2 * MOST_AT_ONCE + 5)]
    parts = [[data["id"] for _, data in listen()] for _ in range(4)]
    assert [len(part) for part in parts] == [MOST_AT_ONCE, MOST_AT_ONCE, 5, 0]
    assert [*chain(*parts)] == [job.pk for job in jobs]


def test_the_work_of_another_world_and_what_still_runs_are_left_out(listen, world, other_world):
    listen()
    end_job(other_world)
    Job.objects.create(world=world, world_name="home", kind=JobKind.GENERATE, status=Status.RUNNING)
    assert listen() == []


@pytest.mark.parametrize(
    "odd", ["x", "1_", "1_job", "9" * 18, "1_job1.", "1" + "_job1.1" * LONGEST_MARK]
)
def test_an_id_that_is_none_is_refused(call_as, annotator, world, odd):
    answer = call_as(annotator, "get", "worlds/home/events/", last_event_id=odd)
    assert (answer.status_code, answer.json()["code"]) == (400, "unreadable_event_id")


@given(
    moments=st.lists(st.integers(0, 10**9), max_size=2 * MOST_TOLD),
    kinds=st.lists(st.sampled_from(["run", "job", "campaign"]), min_size=1),
)
def test_a_mark_is_read_as_it_is_written(moments, kinds):
    mark = Mark(10**15)
    for pk, moment in enumerate(moments):
        at = mark.since + timedelta(microseconds=moment)
        mark = mark.after(Ending(kinds[pk % len(kinds)], 10**9 + pk, "", "", "", at))
        assert len(str(mark)) <= LONGEST_MARK
    assert Mark.read(str(mark)) == mark
