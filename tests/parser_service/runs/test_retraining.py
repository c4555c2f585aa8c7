"""The same configuration is trained again on a split that was frozen anew."""

from __future__ import annotations

import pytest

from annotations.language.texts.errors import Refusal
from annotations.models import Split
from parser_service.models import TrainingRun
from parser_service.models.runs import Status
from parser_service.runs.retraining import retrainable, retrained
from parser_service.runs.run_requests import request, retrain
from tests.parser_service.made_up import make_split


@pytest.fixture
def newer(split) -> Split:
    made = make_split(split.world, "home-2")
    made.follows = split
    made.save()
    return made


@pytest.fixture
def run(split) -> TrainingRun:
    made, _ = request(
        split.world,
        split,
        "knn",
        {"least_overlap": 0.25},
        train_sources="gen+para",
        seed=7,
        send=False,
    )
    TrainingRun.objects.filter(pk=made.pk).update(status=Status.SUCCEEDED)
    made.refresh_from_db()
    return made


def test_a_run_is_asked_for_again_with_its_own_values(run, newer, admin):
    again, is_new = retrain(run, newer, admin)
    assert is_new and again.status == Status.QUEUED and again.created_by == admin
    for name in ("parser", "config", "protocol", "train_sources", "seed"):
        assert getattr(again, name) == getattr(run, name)
    assert again.split == newer
    run.refresh_from_db()
    assert (run.split, run.status) == (newer.follows, Status.SUCCEEDED)


def test_it_is_trained_once(run, newer):
    first, _ = retrain(run, newer)
    assert retrain(run, newer) == (first, False)


def test_a_split_of_another_world_is_refused(run, other_world):
    with pytest.raises(Refusal) as refused:
        retrain(run, make_split(other_world))
    assert refused.value.code == "split_of_another_world"


def test_the_newest_run_of_each_configuration_can_be_retrained(run, newer):
    (row,) = retrainable(newer)
    assert (row.run, row.again) == (run, None)
    again, _ = retrain(run, newer)
    (row,) = retrainable(newer)
    assert row.again == again
    assert retrained(run) == (newer, again)
    TrainingRun.objects.filter(pk=again.pk).update(status=Status.FAILED)
    assert retrained(run) == (newer, None)


def test_runs_without_success_are_not_offered(run, newer):
    TrainingRun.objects.filter(pk=run.pk).update(status=Status.CANCELLED)
    assert retrainable(newer) == []


def test_a_split_that_follows_none_has_nothing_to_retrain(run, split):
    assert retrainable(split) == []
    assert retrained(run) == (None, None)


@pytest.mark.parametrize(
    ("source", "learned", "learns"),
    [
        ("said", "gen+para", "gen+para+said"),
        ("model", "gen+para", "gen+para+model"),
        ("said", "gen", "gen"),  # which leaves out what people say
    ],
)
def test_it_also_learns_from_sources_that_are_new(run, newer, source, learned, learns):
    first = newer.examples.filter(part="train", source="paraphrased").order_by("pk").first()
    newer.examples.filter(pk=first.pk).update(source=source)
    TrainingRun.objects.filter(pk=run.pk).update(train_sources=learned)
    run.refresh_from_db()
    again, _ = retrain(run, newer)
    assert again.train_sources == learns
    assert [each.again for each in retrainable(newer)] == [again]
    assert retrained(run) == (newer, again)


def test_a_source_that_was_left_out_stays_left_out(run, newer):
    for split in (run.split, newer):
        first = split.examples.filter(part="train", source="paraphrased").order_by("pk").first()
        split.examples.filter(pk=first.pk).update(source="said")
    assert retrain(run, newer)[0].train_sources == "gen+para"
