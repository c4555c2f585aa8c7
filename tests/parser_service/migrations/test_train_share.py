"""What older runs learned from."""

from __future__ import annotations

from importlib import import_module

from django.apps import apps

from parser_service.models import TrainingRun
from tests.parser_service.made_up import make_split
from tests.sample_world import scored_run

migration = import_module("parser_service.migrations.0009_train_share")


def test_older_runs_learned_from_all_pairs_of_their_sources(world):
    split = make_split(world)
    gen, both = scored_run(world, split), scored_run(world, split, seed=1)
    waiting = scored_run(world, split, seed=2)
    TrainingRun.objects.filter(pk=both.pk).update(train_sources="gen+para")
    TrainingRun.objects.filter(pk=waiting.pk).update(status="queued")
    migration.count_pairs(apps, None)
    pairs = dict(TrainingRun.objects.values_list("pk", "train_pairs"))
    assert pairs == {gen.pk: 24, both.pk: 48, waiting.pk: None}
    assert {run.train_share for run in TrainingRun.objects.all()} == {1.0}
