"""What parsers answer to a command without a form stands among the forms suggested for its pattern."""

from __future__ import annotations

import pytest

from annotations import background
from annotations.background.carrying_out_jobs import carry_out
from annotations.editing.edits import delete
from annotations.models import (
    CommandProposal,
    Job,
    JobKind,
    Predicate,
    SemanticTemplate,
    TaskCategory,
)
from parser_service.labelling.pattern_suggestions import suggest_with_parsers
from parser_service.runs import lifecycle
from parser_service.runs.train_run import train
from parser_service.serving.loading import _load
from tests.parser_service.requests import ask

COMMAND, PATTERN = "go to the <room>", "go to the {room}"
ADDRESS = "/w/home/templates/suggestions/"


@pytest.fixture
def without_go(sample, annotator):
    """The sample world without the template of ``COMMAND``."""
    delete(SemanticTemplate.objects.get(form="(go {room})"), annotator, 1)
    return sample.world


def answer(world, run, *forms, command=COMMAND):
    for rank, form in enumerate(forms, start=1):
        CommandProposal.objects.create(
            world=world, command=command, source="knn", run=run.pk, rank=rank, form=form, score=0.5
        )


def suggest(world, pattern=PATTERN, by=None):
    category = TaskCategory.objects.get(grammar__world=world)
    return suggest_with_parsers(world, category, pattern, COMMAND, by)


def marks(suggested):
    return {each.text: [answer.parser for answer in each.answers] for each in suggested.forms}


def test_the_best_well_typed_answer_is_marked_with_its_parser(without_go, sample):
    answer(without_go, sample.run, '( fly " <room> " )', '( go " <object> " )', '( go " <room> " )')
    suggested = suggest(without_go)
    assert marks(suggested)["(go {room})"] == ["Nearest neighbour"]
    (kept,) = [each for each in suggested.forms if each.text == "(go {room})"]
    assert kept.answers[0].score == 0.5
    assert suggested.example in ("go to the kitchen", "go to the bath")
    assert kept.gloss == suggested.example
    assert not any("fly" in each.text for each in suggested.forms)


def test_a_new_answer_stands_behind_the_forms_of_the_templates(sample):
    kind = {"kind": "action", "signatures": [["room"]]}
    Predicate.objects.create(world=sample.world, name="wave", **kind)
    pattern = "$vbfind the {kobject} and go to the {room}"
    before = [each.text for each in suggest(sample.world, pattern).forms]
    command = suggest(sample.world, pattern).command
    answer(sample.world, sample.run, '( wave " <room> " )', command=command)
    texts = [each.text for each in suggest(sample.world, pattern).forms]
    assert texts == [*before, "(wave {room})"]


def test_an_answer_that_does_not_fit_is_not_suggested(sample):
    answer(sample.world, sample.run, '( go " <object> " )', '( fly " <room> " )')
    suggested = suggest(sample.world)
    assert "Nearest neighbour" in suggested.reason
    assert set(marks(suggested)) == {"(go {room})"}


def test_another_pattern_has_its_own_command(sample):
    answer(sample.world, sample.run, '( find " <room> " )')
    suggested = suggest(sample.world, "$vbfind the {kobject}")
    assert suggested.command == "find the <object>"
    assert "(find {room})" not in marks(suggested)
    assert suggest(sample.world, "$gone").forms == ()


def test_the_nearest_utterance_answers_at_once(without_go, anna):
    page = anna.post(f"{ADDRESS}?command={COMMAND}", {"pattern": PATTERN}).content.decode()
    assert "nearest utterance" not in page  # no form of it fits
    page = anna.post(ADDRESS, {"pattern": "$vbfind the {kobject}"}).content.decode()
    assert "nearest utterance" in page


def test_a_worker_is_asked_once_and_the_page_takes_its_answer(
    transactional_db, sample, anna, settings, tmp_path
):
    settings.VAR_DIR = tmp_path
    world = sample.world
    train(lifecycle.claim("a worker", "quick", ask(sample.split, train_sources="gen", seed=1)))
    typed = {"pattern": "look for the {kobject}"}
    page = anna.post(ADDRESS, typed).content.decode()
    assert 'hx-trigger="every 2s"' in page
    again = f"{ADDRESS}?waiting&command=look+for+the+<object>"
    assert anna.post(again, typed).status_code == 204
    assert anna.post(again, {"pattern": PATTERN}).status_code == 200
    for _ in range(world.jobs.queued().count()):
        carry_out(background.claim("a worker", "quick", Job))
    assert world.jobs.filter(arguments__has_key="command").count() == 1
    page = anna.post(again, typed).content.decode()
    assert 'hx-trigger="every 2s"' not in page and "Nearest neighbour 1.00" in page


def test_a_parser_that_cannot_answer_is_asked_once(sample, anna, annotator, settings, tmp_path):
    settings.RUNS_DIR = tmp_path  # other tests saved parsers of runs with the same numbers
    _load.cache_clear()
    assert suggest(sample.world, by=annotator).waits_for == "Nearest neighbour"
    job = sample.world.jobs.get(kind=JobKind.PROPOSE)
    carry_out(background.claim("a worker", "quick", Job))
    job.refresh_from_db()
    assert str(tmp_path) in job.report["sentence"]
    assert "Nearest neighbour" in suggest(sample.world, by=annotator).reason
    assert sample.world.jobs.filter(kind=JobKind.PROPOSE).count() == 1


def test_no_parser_is_asked_about_a_command_beyond_the_column(sample, annotator):
    suggested = suggest(sample.world, "{object} " * 60, annotator)
    assert suggested.command == "" and not Job.objects.filter(kind=JobKind.PROPOSE).exists()
    longest = suggest(sample.world, "{object} " * 55, annotator)
    assert len(longest.command) == 55 * len("<object> ") - 1


@pytest.mark.services
def test_a_long_pattern_ends_no_job(transactional_db, sample, anna, settings, tmp_path):
    settings.VAR_DIR = tmp_path
    train(lifecycle.claim("a worker", "quick", ask(sample.split, train_sources="gen", seed=1)))
    for how_many in (54, 55, 56, 60, 400):
        assert anna.post(ADDRESS, {"pattern": "{object} " * how_many}).status_code == 200
    while job := background.claim("a worker", "quick", Job):
        carry_out(job)
    assert not sample.world.jobs.exclude(status="succeeded").exists()
    assert sample.world.jobs.filter(arguments__has_key="command").exists()
