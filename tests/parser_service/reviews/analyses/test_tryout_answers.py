"""Texts that people try: one row a person, one job a world, the newest text wins."""

from __future__ import annotations

import pytest

from annotations import background
from annotations.background.requesting import request_job
from annotations.models import Job, JobKind
from parser_service.models import Tryout
from parser_service.reviews import tryout_answers
from parser_service.reviews.tryout_answers import answer_jobs, ask
from parser_service.runs.checkpoints import model_folder, remove_folder
from tests.parser_service.reviews.analyses.conftest import done
from tests.parser_service.reviews.analyses.made_parsers import BRING, DEFAULT, FIND


@pytest.fixture
def hasty(settings):
    """The job stays for next to no time."""
    settings.WORK_TEMPO = 10_000
    return settings


@pytest.fixture
def runs(train_one):
    """Two runs, whose own analyses are out of the way."""
    made = [train_one("always-one"), train_one("one-word")]
    Job.objects.all().delete()
    return made


def answer_all(world) -> Job:
    return done(answer_jobs(world).get())


def test_a_worker_answers_with_every_chosen_run(runs, annotator, hasty):
    row = ask(runs[0].world, annotator, "find me a thing", runs)
    assert not row.is_answered and row.open_runs == [run.pk for run in runs]
    job = answer_all(runs[0].world)
    assert (job.status, job.failure, job.report) == ("succeeded", "", {"answered": 1})
    row.refresh_from_db()
    assert row.is_answered
    assert [row.answers[str(run.pk)]["answers"][0]["form"] for run in runs] == [DEFAULT, FIND]


def test_a_page_that_read_the_row_before_its_answer_asks_for_no_further_job(runs, annotator, hasty):
    row = ask(runs[0].world, annotator, "find me a thing", runs)
    answer_all(runs[0].world)
    assert not row.is_answered, "it is as it was read"
    assert tryout_answers.request_answers(row) is None
    assert not answer_jobs(runs[0].world).exists()


def test_the_newest_text_of_a_person_takes_the_place_of_older_ones(runs, annotator, hasty):
    for text in ("bring", "bring a", "bring a thing"):
        ask(runs[0].world, annotator, text, runs)
    assert answer_jobs(runs[0].world).count() == 1
    assert answer_all(runs[0].world).report == {"answered": 1}
    assert Tryout.objects.get().text == "bring a thing"


def test_an_answer_to_an_older_text_is_dropped(runs, annotator, hasty, monkeypatch):
    ask(runs[0].world, annotator, "find me", runs)
    real, texts = tryout_answers._Answering._ask, []

    def type_on(self, run, text):
        texts.append(text)
        if len(texts) == 1:
            ask(run.world, annotator, "bring it", runs)
        return real(self, run, text)

    monkeypatch.setattr(tryout_answers._Answering, "_ask", type_on)
    answer_all(runs[0].world)
    assert texts == ["find me", "bring it", "bring it"]
    row = Tryout.objects.get()
    assert (row.text, row.is_answered) == ("bring it", True)
    assert row.answers[str(runs[1].pk)]["answers"][0]["form"] == BRING


def test_the_answers_before_are_kept_to_compare_with(runs, annotator, hasty):
    world = runs[0].world
    ask(world, annotator, "find me", runs)
    answer_all(world)
    row = ask(world, annotator, "find it", runs)
    assert row.before["text"] == "find me" and str(runs[1].pk) in row.before["answers"]


def test_a_run_that_is_added_is_asked_alone(runs, annotator, hasty):
    world = runs[0].world
    ask(world, annotator, "find me", runs[:1])
    answer_all(world)
    assert ask(world, annotator, "find me", runs).open_runs == [runs[1].pk]
    assert ask(world, annotator, "find me", runs[:1]).is_answered


def test_everybody_is_answered_by_one_job(runs, annotator, reviewer, hasty):
    world = runs[0].world
    ask(world, annotator, "find me", runs)
    ask(world, reviewer, "bring it", runs)
    assert answer_all(world).report == {"answered": 2}
    assert not Tryout.objects.waiting().exists()


def test_a_job_yields_to_other_work(runs, annotator):
    """It would stay for 20 seconds otherwise."""
    world = runs[0].world
    ask(world, annotator, "find me", runs)
    job = answer_jobs(world).get()
    request_job(JobKind.GENERATE, world.name, None)
    assert done(job).status == "succeeded"


def test_a_parser_that_cannot_be_loaded_is_said_and_the_others_answer(runs, annotator, hasty):
    remove_folder(model_folder(runs[0].pk))
    ask(runs[0].world, annotator, "find me", runs)
    answer_all(runs[0].world)
    answers = Tryout.objects.get().answers
    assert str(model_folder(runs[0].pk)) in answers[str(runs[0].pk)]["problem"]
    assert answers[str(runs[1].pk)]["answers"]


def test_a_cancelled_job_leaves_the_text_for_the_next(runs, annotator, hasty):
    row = ask(runs[0].world, annotator, "find me", runs)
    background.cancel(answer_jobs(row.world).get())
    assert not answer_jobs(row.world).exists()
    ask(row.world, annotator, "find me", runs)
    answer_all(row.world)
    row.refresh_from_db()
    assert row.is_answered
