from __future__ import annotations

from collections import Counter

import pytest

from annotations.language.texts.errors import Refusal
from annotations.models import Split
from annotations.models.campaigns import ContributorKind
from annotations.people.rate_limits import STARTED_RUNS
from parser_service.labelling.people_against_models import run_pairs, start_people_against_models
from parser_service.models import TrainingRun
from parser_service.runs import lifecycle
from parser_service.runs.split_pairs import training_pairs
from parser_service.runs.train_run import train
from tests.launched_campaigns import small_campaign
from tests.parser_service.made_up import made_up_pairs
from tests.sample_world import make_paraphrase

FIGURES = "/w/home/paraphrases/figures/"
RUNS = "/api/v1/worlds/home/paraphrase-figures/runs/"


@pytest.fixture
def paraphrases(world) -> None:
    """Of each of 36 commands three paraphrases of people and one of a model."""
    model = small_campaign(world).contributors.create(kind=ContributorKind.MODEL, pseudonym="m")
    for command, said, form in made_up_pairs():
        texts = {"kindly": None, "now": None, "for me": None, "would you": model}
        for addition, contributor in texts.items():
            make_paraphrase(
                world,
                prompt=command,
                utterance=f"{said} {addition}",
                logical_form=form,
                contributor=contributor,
            )


def test_two_runs_differ_in_who_wrote_what_they_learn_from(paraphrases, world, admin):
    answers = start_people_against_models(world, "seq2seq", admin)
    (people, is_new), (models, _) = answers
    assert is_new
    assert (people.train_sources, models.train_sources) == ("para", "model")
    assert people.split == models.split
    assert people.split.criterion == "logical_form"
    # The same forms, each as often.
    of_people, of_models = (
        Counter(pair.form for pair in training_pairs(run.split, run.train_sources))
        for run, _ in answers
    )
    assert of_people == of_models
    assert of_people.total() > 10
    assert not people.split.examples.filter(part="test", source="model").exists()
    tested = people.split.examples.filter(part="test", source="paraphrased")
    forms = set(tested.values_list("logical_form", flat=True))
    trained = people.split.examples.filter(part="train")
    assert forms
    assert not trained.filter(logical_form__in=forms).exists()
    assert STARTED_RUNS.left(str(admin.pk)) == STARTED_RUNS.limit - 2


def test_a_parser_that_writes_no_new_form_is_split_by_source_command(paraphrases, world, admin):
    (people, _), _ = start_people_against_models(world, "knn", admin)
    assert people.split.criterion == "source_command"


def test_the_split_and_the_runs_are_used_again(paraphrases, world, admin):
    first = start_people_against_models(world, "seq2seq", admin)
    again = start_people_against_models(world, "seq2seq", admin)
    assert [run for run, _ in first] == [run for run, _ in again]
    assert not any(is_new for _, is_new in again)
    assert Split.objects.count() == 1
    make_paraphrase(world, utterance="one more", logical_form="( go 1 )")
    start_people_against_models(world, "seq2seq", admin)
    assert set(Split.objects.values_list("name", flat=True)) == {
        "people-models-form-1",
        "people-models-form-2",
    }


def test_nothing_starts_without_both(world, admin):
    with pytest.raises(Refusal) as refused:
        start_people_against_models(world, "no such parser", admin)
    assert refused.value.code == "unknown_parser"
    for command, said, form in made_up_pairs():
        make_paraphrase(world, prompt=command, utterance=said, logical_form=form)
    with pytest.raises(Refusal) as refused:
        start_people_against_models(world, "knn", admin)
    assert refused.value.code == "too_few_paraphrases"
    assert not Split.objects.exists()


def test_nothing_starts_beyond_the_limit(paraphrases, world, admin):
    for _ in range(STARTED_RUNS.limit - 1):
        STARTED_RUNS.take(str(admin.pk))
    with pytest.raises(Refusal) as refused:
        start_people_against_models(world, "knn", admin)
    assert refused.value.code == "too_many_runs"
    assert not TrainingRun.objects.exists()


def test_trained_runs_show_their_accuracies(transactional_db, paraphrases, world, admin, rene):
    for run, _ in start_people_against_models(world, "knn", admin):
        train(lifecycle.claim("the test", run.queue, run))
    (pair,) = run_pairs(world)
    assert pair.are_scored
    assert not pair.is_active
    assert rene.get(f"{FIGURES}runs/").context["pairs"] == [pair]
    (shown,) = rene.get(RUNS).json()["results"]
    for side in ("people", "models"):
        row = shown[side]
        assert row["low"] <= row["percent"] <= row["high"]
        assert row["run"]["train_pairs"] > 0
        assert row["parts"] == []


def test_other_runs_are_not_compared(paraphrases, world, admin):
    (people, _), (models, _) = start_people_against_models(world, "knn", admin)
    assert [pair.models for pair in run_pairs(world)] == [models]
    TrainingRun.objects.filter(pk=people.pk).update(train_share=0.5)
    assert run_pairs(world) == []
    TrainingRun.objects.filter(pk=people.pk).update(train_share=1)
    people.split.examples.filter(part="train", source="model").first().delete()
    assert run_pairs(world) == []


def test_the_button_starts_both_runs(paraphrases, world, client, admin, rene):
    client.force_login(admin)
    part = client.get(f"{FIGURES}runs/")
    assert part.context["chosen"] == "knn"  # recommended for so few pairs
    assert f"{FIGURES}runs/start/" in part.content.decode()
    assert f"{FIGURES}runs/start/" not in rene.get(f"{FIGURES}runs/").content.decode()
    assert client.post(f"{FIGURES}runs/start/", {"parser": "linear"}).status_code == 302
    assert TrainingRun.objects.filter(parser="linear").count() == 2
    assert client.get(f"{FIGURES}runs/").context["is_active"]


def test_a_program_starts_both_runs(paraphrases, client, admin):
    client.force_login(admin)
    sent = {"data": {"parser": "knn"}, "content_type": "application/json"}
    answer = client.post(RUNS, **sent)
    assert (answer.status_code, answer.json()["new"]) == (201, 2)
    answer = client.post(RUNS, **sent)
    assert (answer.status_code, answer.json()["new"]) == (200, 0)
    assert client.post(RUNS, {}, content_type="application/json").status_code == 400
