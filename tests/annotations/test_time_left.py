"""How long running work still takes: told by its progress, and only where that says something."""

from __future__ import annotations

from datetime import timedelta

import pytest
from django.utils import timezone

from annotations.models import Job
from annotations.models.background import Status
from annotations.showing.figures import rough_duration
from parser_service.models import TrainingRun


def work(model=TrainingRun, seconds=600, progress=0.25, status=Status.RUNNING, attempt=1):
    started = timezone.now() - timedelta(seconds=seconds)
    return model(started_at=started, progress=progress, status=status, attempt=attempt)


@pytest.mark.parametrize("model", [TrainingRun, Job])
def test_the_rest_takes_as_long_as_its_share_did(model):
    assert work(model).seconds_left == pytest.approx(1800, rel=0.01)
    assert work(model, progress=1).seconds_left == 0


@pytest.mark.parametrize(
    "unknown",
    [
        {"seconds": 59, "progress": 0.9},
        {"progress": 0.04},
        {"attempt": 2},
        {"status": Status.QUEUED},
        {"status": Status.SUCCEEDED},
    ],
)
def test_nothing_is_made_up(unknown):
    assert work(**unknown).seconds_left is None


def test_an_estimate_is_written_roughly():
    written = [rough_duration(seconds) for seconds in (None, 3, 60, 1800, 12_000)]
    assert written == ["", "a few seconds", "about a minute", "about 30 min", "about 3 h"]


def test_pages_and_routes_tell_it_of_a_run(sample, anna):
    run = sample.run
    started = timezone.now() - timedelta(seconds=600)
    TrainingRun.objects.filter(pk=run.pk).update(
        status=Status.RUNNING, started_at=started, progress=0.25, attempt=1
    )
    for address in ("runs/", f"runs/{run.pk}/", "runs/table/"):
        assert "about 30 min left" in anna.get(f"/w/home/{address}").content.decode(), address
    shown = anna.get(f"/api/v1/worlds/home/runs/{run.pk}/").json()
    assert shown["seconds_left"] == pytest.approx(1800, rel=0.05)
    TrainingRun.objects.filter(pk=run.pk).update(progress=0.01)
    page = anna.get(f"/w/home/runs/{run.pk}/").content.decode()
    assert "time left not known yet" in page
    assert anna.get(f"/api/v1/worlds/home/runs/{run.pk}/").json()["seconds_left"] is None


def test_pages_and_routes_tell_it_of_a_job(world, adam):
    started = timezone.now() - timedelta(seconds=600)
    job = Job.objects.create(
        world=world, kind="generate", status="running", started_at=started, progress=0.5, attempt=1
    )
    for address in (f"/jobs/{job.pk}/", "/w/home/jobs/"):
        answer = adam.get(address, follow=True)
        assert "about 10 min left" in answer.content.decode(), address
    shown = adam.get(f"/api/v1/worlds/home/jobs/{job.pk}/").json()
    assert shown["seconds_left"] == pytest.approx(600, rel=0.05)
