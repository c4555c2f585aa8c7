"""Runs on a split by form are asked for known forms, too."""

from __future__ import annotations

import pytest

from annotations.language.corpus import Criterion
from annotations.models import Split
from parser_service.runs import run_requests
from parser_service.runs.split_pairs import cluster_of, item_of, known_examples, training_pairs
from tests.parser_service.made_up import make_split
from tests.parser_service.runs.test_train_run import trained


@pytest.fixture
def split(world, transactional_db):
    made = make_split(world)
    commands = dict(made.examples.filter(source="generated").values_list("position", "utterance"))
    for said in made.examples.filter(source="paraphrased"):
        made.examples.filter(pk=said.pk).update(source_command=commands[said.position])
    Split.objects.update(criterion="logical_form")
    made.refresh_from_db()
    return made


def test_known_pairs_are_held_out_scored_and_of_forms_in_training(split):
    run = trained(split, train_sources="gen+para")
    known = known_examples(split, run.seed)
    assert {each.source for each in known} == {"generated", "paraphrased"}
    assert len(known) < 10
    assert run.train_pairs == 48 - len(known)
    scores = {(each.part, each.test_source): each for each in run.evaluations.all()}
    score = scores["known", "mixed"]
    assert score.count == len(known)
    assert score.interval_low <= score.accuracy <= score.interval_high
    assert sum(counts[0] for counts in score.outcomes.values()) == score.count
    held_out = {each.pk for each in known}
    trained_forms = {p.form for p in training_pairs(split, "gen+para", without=held_out)}
    assert {each.logical_form for each in known} <= trained_forms
    assert not run.predictions.filter(example__part="train").exists()
    log = " ".join(event.message for event in run.events.all())
    assert f"{len(known)} pairs of known forms " in log


def test_other_seeds_hold_out_others_and_equal_ones_the_same(split):
    keys = [tuple(each.pk for each in known_examples(split, seed)) for seed in range(6)]
    assert len(set(keys)) > 1
    assert keys[0] == tuple(each.pk for each in known_examples(split, 0))


@pytest.mark.parametrize("criterion", ["command", "source_command"])
def test_on_other_splits_nothing_is_held_out(split, criterion):
    Split.objects.update(criterion=criterion)
    split.refresh_from_db()
    assert known_examples(split, 0) == []
    run = trained(split)
    assert run.train_pairs == 24
    assert {each.part for each in run.evaluations.all()} == {"validation", "test"}


def test_a_run_by_form_is_another_one_than_before_known_forms_were_held_out(split, monkeypatch):
    run, _ = run_requests.request(split.world, split, "knn", send=False)
    monkeypatch.setattr("parser_service.runs.content_key.KNOWN_SHARE", 0.2)
    other, is_new = run_requests.request(split.world, split, "knn", send=False)
    assert is_new
    assert other.content_key != run.content_key


def test_clusters_are_forms_by_form_and_source_commands_else(split):
    example = split.examples.filter(source="paraphrased").first()
    assert cluster_of(example, "logical_form") == example.logical_form
    assert cluster_of(example, "command") == item_of(example).key(Criterion.SOURCE_COMMAND)
