"""Which run answers in a world, and how that changes."""

from __future__ import annotations

from importlib import import_module

import pytest
from django.apps import apps

from annotations.models import Split
from parser_service.models import Promotion, TrainingRun
from parser_service.promotion import (
    consider,
    decline,
    previous_run,
    promote,
    promoted_run,
    roll_back,
)
from parser_service.runs import lifecycle
from parser_service.runs.carrying_out.training import train
from parser_service.runs.requests import requesting
from tests.parser_service.made_up import make_split
from tests.parser_service.served import score, trained_run


@pytest.fixture
def split(world):
    return make_split(world)


def frozen_anew(split: Split) -> Split:
    later = make_split(split.world, f"{split.name}-2")
    later.follows = split
    later.save()
    return later


def test_the_first_run_that_was_tested_on_paraphrases_answers_by_itself(split):
    assert consider(trained_run(split, spoken=None)) is None
    first = trained_run(split, seed=1)
    row = consider(first)
    assert promoted_run(split.world) == first
    assert (row.state, row.decided_by, row.evidence["before"]) == ("promoted", None, None)
    assert row.evidence["run"][0]["accuracy"] == 0.5
    assert consider(trained_run(split, seed=2, spoken=0.9)) is None
    assert promoted_run(split.world) == first


def test_a_run_that_is_never_right_on_paraphrases_is_not_promoted_by_itself(split):
    assert consider(trained_run(split, spoken=0.0)) is None


def test_a_parser_that_trains_in_seconds_leaves_it_to_others_on_their_way(split):
    waiting, _ = requesting.request(split.world, split, "seq2seq", send=False)
    assert consider(trained_run(split)) is None
    TrainingRun.objects.filter(pk=waiting.pk).update(status="failed")
    assert consider(trained_run(split, seed=1)).state == "promoted"


def test_a_run_on_a_share_of_the_pairs_does_not_count(split):
    run = trained_run(split)
    TrainingRun.objects.filter(pk=run.pk).update(train_share=0.5)
    assert consider(run) is None


def test_training_considers_the_run(world, transactional_db):
    split = make_split(world)
    known = split.examples.get(part="train", source="paraphrased", position=1)
    asked = split.examples.filter(part="validation", source="paraphrased")
    asked.update(utterance=known.utterance, logical_form=known.logical_form)
    run, _ = requesting.request(world, split, "knn", train_sources="gen+para", send=False)
    train(lifecycle.claim("the test", run.queue, run))
    assert promoted_run(world) == run


def test_an_admin_promotes_with_the_evidence_of_both(split, admin):
    first, second = trained_run(split), trained_run(split, seed=1, spoken=0.75)
    promote(first, None)
    row = promote(second, admin, "  better\n with  names ")
    assert promoted_run(split.world) == second
    assert (row.reason, row.decided_by) == ("better with names", admin)
    assert row.evidence["run"][0]["accuracy"] == 0.75
    assert row.evidence["before"] == {"run": first.pk, "scores": row.evidence["before"]["scores"]}
    assert row.evidence["before"]["scores"][0]["accuracy"] == 0.5


def test_only_a_run_that_succeeded_and_is_not_there_yet_is_promoted(split, admin):
    queued, _ = requesting.request(split.world, split, "knn", seed=9, send=False)
    with pytest.raises(ValueError, match="is queued; only a run that succeeded"):
        promote(queued, admin)
    run = trained_run(split)
    promote(run, admin)
    with pytest.raises(ValueError, match="is the promoted one already"):
        promote(run, admin)
    assert Promotion.objects.count() == 1


def test_rolling_back_goes_back_step_by_step(split, admin):
    runs = [trained_run(split, seed=seed) for seed in range(3)]
    for run in runs:
        promote(run, admin)
    assert previous_run(split.world) == runs[1]
    roll_back(split.world, admin, "it refuses doors")
    assert promoted_run(split.world) == runs[1]
    assert split.world.promotions.promoted().first().reason == "Rolled back. it refuses doors"
    assert roll_back(split.world, admin).run == runs[0]
    with pytest.raises(ValueError, match="none to go back to"):
        roll_back(split.world, admin)
    promote(runs[2], admin)
    assert previous_run(split.world) == runs[0]


def test_worlds_do_not_share_a_promotion(split, other_world):
    other = trained_run(make_split(other_world, "other"))
    promote(other, None)
    assert promoted_run(split.world) is None
    assert list(Promotion.objects.present()) == [other.promotions.get()]


def test_retraining_after_the_corpus_changed_proposes_and_never_switches(split, admin):
    first = trained_run(split, spoken=0.5)
    consider(first)
    later = frozen_anew(split)
    row = consider(trained_run(later, spoken=0.45))
    assert row.state == "proposed"
    assert "after the corpus changed since home: 45.0 % on validation paraphrases" in row.reason
    assert promoted_run(split.world) == first
    better = trained_run(later, seed=1, spoken=0.6)
    assert consider(better).state == "proposed"
    row.refresh_from_db()
    assert row.state == "overtaken"
    assert consider(trained_run(later, seed=2, spoken=0.55)) is None
    assert promote(better, admin).reason.startswith("Trained on home-2")
    assert Promotion.objects.proposed().count() == 0


def test_nothing_is_proposed_on_the_same_corpus_or_where_it_is_clearly_worse(split):
    consider(trained_run(split, spoken=0.5))
    assert consider(trained_run(split, seed=1, spoken=0.9)) is None
    assert consider(trained_run(frozen_anew(split), spoken=0.35)) is None
    assert not Promotion.objects.proposed()


def test_a_proposal_is_declined_once(split, admin):
    consider(trained_run(split, spoken=0.5))
    row = consider(trained_run(frozen_anew(split), spoken=0.5))
    assert decline(split.world, row.pk, admin).state == "declined"
    with pytest.raises(ValueError, match="decided already"):
        decline(split.world, row.pk, admin)


def test_installations_from_before_promotion_keep_their_best_run(split):
    trained_run(split, spoken=0.4)
    best = trained_run(split, seed=1, spoken=0.6)
    score(trained_run(split, seed=2, spoken=None), 0.9, source="gen")
    import_module("parser_service.migrations.0010_promotion").promote_the_best(apps, None)
    assert promoted_run(split.world) == best
