"""Runs of the parsers made for these tests, trained by the worker's code and analysed."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from annotations import background
from annotations.background.carrying_out_jobs import carry_out
from annotations.models import Job
from parser_service.models import TrainingRun
from parser_service.runs.analysis_requests import analysis_jobs, request_analysis
from parser_service.serving import loading
from tests.parser_service.reviews.analyses.made_parsers import register_all
from tests.parser_service.runs.test_train_run import trained
from tests.sample_world import SampleWorld


@pytest.fixture
def home(transactional_db, sample, monkeypatch) -> SampleWorld:
    """A world whose runs may be of the parsers made for these tests."""
    register_all(monkeypatch)
    loading._load.cache_clear()
    return sample


@pytest.fixture
def train_one(home) -> Callable[..., TrainingRun]:
    """Returns a function that trains a parser on the split of the world."""

    def train(parser: str, **asked) -> TrainingRun:
        run = trained(home.split, parser, train_sources="gen+para", **asked)
        assert (run.status, run.failure) == ("succeeded", "")
        return run

    return train


@pytest.fixture
def analysed(train_one) -> Callable[..., TrainingRun]:
    """Returns a function that trains a parser and lets a worker analyse its errors."""

    def analyse(parser: str, **asked) -> TrainingRun:
        run = train_one(parser, **asked)
        job = done(analysis_jobs(run).get())
        assert (job.status, job.failure) == ("succeeded", "")
        return run

    return analyse


def done(job: Job) -> Job:
    """The job after a worker has carried it out."""
    carry_out(background.claim("a worker", job.queue, Job, job))
    job.refresh_from_db()
    return job


def analyse_again(run: TrainingRun) -> Job:
    return done(request_analysis(run))
