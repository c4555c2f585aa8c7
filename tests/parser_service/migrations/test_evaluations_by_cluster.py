"""Scores from before outcomes were counted by cluster."""

from __future__ import annotations

from importlib import import_module

import pytest
from django.apps import apps

from parser_service.models import Evaluation
from tests.parser_service.made_up import make_split
from tests.parser_service.runs.training.test_train_run import trained

migration = import_module("parser_service.migrations.0014_evaluations_by_cluster")


@pytest.fixture
def run(world, transactional_db):
    return trained(make_split(world), train_sources="gen+para")


def scores_of(run):
    """The scores of a run. Plans were not compared then, so the last figure of an outcome is left out."""
    scores = list(run.evaluations.values())
    for score in scores:
        score["outcomes"] = {key: counts[:4] for key, counts in score["outcomes"].items()}
    return scores


def test_older_scores_get_what_a_run_stores(run):
    before = scores_of(run)
    run.evaluations.update(outcomes={}, interval_low=0.1, interval_high=0.2)
    migration.count(apps, None)
    assert scores_of(run) == before


def test_a_score_whose_predictions_are_gone_stays_as_it_is(run):
    run.evaluations.update(outcomes={}, interval_low=0.1, interval_high=0.2)
    run.predictions.filter(example__part="test").delete()
    migration.count(apps, None)
    kept = Evaluation.objects.filter(part="test")
    assert {(each.interval_low, each.outcomes == {}) for each in kept} == {(0.1, True)}
    assert all(each.outcomes for each in Evaluation.objects.filter(part="validation"))
