"""One press freezes the world of today, and trains on it what answers here, or what is recommended."""

from __future__ import annotations

import pytest

from annotations.background.progress import UNWATCHED
from annotations.generation import freezing_job
from annotations.models import Job
from annotations.models.background import Status
from parser_service.models import TrainingRun
from parser_service.runs.promoting import promote
from parser_service.runs.recommended import advise
from parser_service.runs.training_today import train_of, train_today
from tests.at_once import at_once
from tests.launched_campaigns import fill_household
from tests.replaying import made_once
from tests.sample_world import make_paraphrase


@pytest.fixture
def household(world):
    return made_once(fill_household, world)


def say_otherwise(world) -> None:
    command = world.commands.select_related("logical_form").first()
    make_paraphrase(
        world,
        command.anonymized_text,
        "would you kindly see to that",
        command=command,
        logical_form=command.logical_form.text,
        grounded_form=command.logical_form.text,
    )


def test_the_first_press_freezes_and_starts_what_is_recommended(household, adam):
    answer = adam.post("/w/home/runs/today/")
    (split,), (run,) = household.splits.all(), household.runs.all()
    assert answer.url == f"/w/home/runs/{run.pk}/"
    recommended = advise(household, split).recommendation
    assert (run.split, run.parser, run.protocol) == (
        split,
        recommended.parser,
        recommended.protocol,
    )
    assert (run.train_sources, run.seed, run.status) == ("gen", 0, Status.QUEUED)


def test_nothing_new_makes_no_second_split(household, admin):
    first, _ = train_today(household, admin)
    assert train_today(household, admin) == (first, False)
    assert household.splits.count() == household.runs.count() == 1


def test_what_was_promoted_is_trained_again_with_what_people_wrote(household, admin):
    run, _ = train_today(household, admin)
    TrainingRun.objects.filter(pk=run.pk).update(status=Status.SUCCEEDED)
    promote(TrainingRun.objects.get(pk=run.pk), admin)
    say_otherwise(household)
    again, is_new = train_today(household, admin)
    assert is_new and again.split.follows == run.split
    assert (again.parser, again.config) == (run.parser, run.config)
    assert again.split.examples.filter(source="paraphrased").count() == 1
    assert train_today(household, admin)[0].split == again.split


@pytest.mark.services
def test_twenty_presses_at_once_make_one_split_and_one_run(transactional_db, world, admin):
    household = made_once(fill_household, world)
    for presses in range(1, 3):  # with nothing frozen, then with a split that is out of date
        runs = at_once(*[lambda: train_today(household, admin)[0].pk] * 20)
        assert len(set(runs)) == 1 and None not in runs
        assert household.splits.count() == household.runs.count() == presses
        say_otherwise(household)


def test_a_large_world_is_frozen_by_a_job_that_starts_the_run(household, adam, monkeypatch):
    monkeypatch.setattr(freezing_job, "MOST_EXAMPLES", 2)
    answer = adam.post("/w/home/runs/today/")
    job = Job.objects.get(kind="train")
    assert answer.url.rstrip("/").endswith(f"/{job.pk}") and not household.splits.exists()
    assert adam.post("/w/home/runs/today/").url == answer.url
    report = train_of(job, UNWATCHED)
    run = household.runs.get()
    assert report == {"split": run.split_id, "run": run.pk}
    Job.objects.filter(pk=job.pk).update(status=Status.SUCCEEDED, report=report)
    assert f"/w/home/runs/{run.pk}/" in adam.get(answer.url).content.decode()


def test_a_world_without_commands_is_told_so(world, adam):
    answer = adam.post("/w/home/runs/today/", follow=True)
    assert answer.status_code == 200 and [each.level for each in answer.context["messages"]] == [40]
    assert not world.splits.exists() and not world.runs.exists()
