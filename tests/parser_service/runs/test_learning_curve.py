"""Runs on shares of the training pairs."""

from __future__ import annotations

from itertools import pairwise

import pytest

from annotations.models import Split
from parser_service.models import TrainingRun
from parser_service.runs import run_requests
from parser_service.runs.learning_curve import SHARES, request_learning_curve
from parser_service.runs.split_pairs import pairs_of, training_pairs
from tests.parser_service.made_up import make_split
from tests.parser_service.runs.test_train_run import trained


@pytest.mark.parametrize("criterion", ["command", "source_command", "logical_form"])
@pytest.mark.parametrize("sources", ["gen", "para", "gen+para"])
def test_the_pairs_of_the_shares_are_nested_and_in_order(criterion, sources, split):
    Split.objects.update(criterion=criterion)
    split.refresh_from_db()
    drawn = [training_pairs(split, sources, share, seed=3) for share in SHARES]
    assert drawn[-1] == pairs_of(split, "train", sources)
    for small, large in pairwise(drawn):
        assert 0 < len(small) <= len(large)
        assert [pair for pair in large if pair in small] == small
    assert drawn[1] == training_pairs(split, sources, 0.25, seed=3)


def test_by_logical_form_a_share_of_the_pairs_has_a_share_of_the_forms(split):
    Split.objects.update(criterion="logical_form")
    split.refresh_from_db()
    half, every = (training_pairs(split, "gen+para", share) for share in (0.5, 1))
    drawn = {pair.form for pair in half}
    assert drawn < {pair.form for pair in every}
    assert half == [pair for pair in every if pair.form in drawn]


def test_a_run_learns_from_its_share_and_says_from_how_many_pairs(world, transactional_db):
    split = make_split(world)
    half, whole = trained(split, train_share=0.5), trained(split)
    drawn = training_pairs(split, "gen", 0.5)
    assert (half.train_pairs, whole.train_pairs) == (len(drawn), 24)
    assert half.train_pairs < 24
    forms = [pair.form for pair in drawn]
    for row in half.predictions.select_related("example"):
        assert row.answer_in_training == forms.count(row.logical_form)
        assert row.label_in_training == forms.count(row.example.logical_form)
    assert f"{len(drawn)} pairs to train on" in " ".join(e.message for e in half.events.all())


def test_one_request_starts_what_is_missing_and_no_more(split):
    whole, _ = run_requests.request(split.world, split, "knn", seed=5, send=False)
    run_requests.request(split.world, split, "knn", seed=5, send=False, train_share=0.25)
    new = request_learning_curve(whole, send=False)
    assert [run.train_share for run in new] == [0.1, 0.5]
    assert {(run.seed, run.queue) for run in new} == {(5, "quick")}
    assert request_learning_curve(whole, send=False) == []
    assert TrainingRun.objects.count() == 4


def test_a_run_on_a_share_is_no_seed_of_the_whole_one(split):
    whole, _ = run_requests.request(split.world, split, "knn", seed=1, send=False)
    run_requests.request(split.world, split, "knn", seed=2, send=False, train_share=0.5)
    assert list(TrainingRun.objects.all().seeds_of(whole)) == [whole]
