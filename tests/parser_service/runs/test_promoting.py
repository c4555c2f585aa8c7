"""Which run answers in a world, and how that changes."""

from __future__ import annotations

import pytest

from annotations.generation.split_statistics import store_figures
from annotations.language.texts.errors import Refusal
from annotations.models import Split, World
from parser_service.models import Promotion, TrainingRun
from parser_service.runs import lifecycle, run_requests
from parser_service.runs.promoting import (
    decline,
    learned_part,
    previous_run,
    promote,
    promoted_run,
    roll_back,
)
from parser_service.runs.promotion_rule import consider
from parser_service.runs.train_run import train
from tests.parser_service.made_up import make_split
from tests.parser_service.served import score, trained_run


def known_split(world: World, name: str = "home", new: int = 0) -> Split:
    """A split whose validation part asks for forms that training has, but for ``new`` of its twelve pairs."""
    split = make_split(world, name)
    known = split.examples.filter(part="train").first().logical_form
    asked = split.examples.filter(part="validation").values_list("pk", flat=True)
    split.examples.filter(pk__in=asked[new:]).update(logical_form=known)
    for number, pk in enumerate(asked[:new]):
        split.examples.filter(pk=pk).update(logical_form=f"( new{number} )")
    store_figures(split)
    return split


@pytest.fixture
def split(world):
    return known_split(world)


def frozen_anew(split: Split) -> Split:
    later = known_split(split.world, f"{split.name}-2")
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


def test_a_run_that_is_surer_to_be_right_overtakes_by_itself(split):
    consider(trained_run(split, spoken=0.5))
    assert consider(trained_run(split, seed=1, spoken=0.5)) is None
    better = trained_run(split, seed=2, spoken=0.51)
    row = consider(better)
    assert (row.run, row.state, row.decided_by) == (better, "promoted", None)
    assert row.evidence["before"]["scores"][0]["accuracy"] == 0.5
    assert promoted_run(split.world) == better
    assert not Promotion.objects.proposed()


def test_the_lower_end_of_the_interval_decides_not_the_accuracy(split):
    first = trained_run(split, spoken=0.5)
    consider(first)
    unsure = trained_run(split, seed=1, spoken=0.6)
    unsure.evaluations.update(interval_low=0.4, interval_high=0.8)
    assert consider(unsure) is None
    sure = trained_run(split, seed=2, spoken=0.5)
    sure.evaluations.update(interval_low=0.45)
    assert consider(sure).state == "promoted"


def test_what_a_person_promoted_is_not_overtaken_but_a_better_run_is_proposed(split, admin):
    first, other = (trained_run(split, seed=seed, spoken=0.5) for seed in (0, 1))
    consider(first)
    promote(other, admin)
    row = consider(trained_run(split, seed=2, spoken=0.9))
    assert row.state == "proposed"
    assert promoted_run(split.world) == other
    assert consider(trained_run(split, seed=3, spoken=0.5)) is None
    roll_back(split.world, admin)
    assert consider(trained_run(split, seed=4, spoken=0.95)).state == "proposed"
    assert promoted_run(split.world) == first


def test_runs_on_other_splits_do_not_overtake(split):
    first = trained_run(split, spoken=0.5)
    consider(first)
    assert consider(trained_run(known_split(split.world, "another"), spoken=0.9)) is None
    assert promoted_run(split.world) == first


def test_by_form_the_harmonic_mean_is_compared(split):
    Split.objects.filter(pk=split.pk).update(criterion="logical_form")
    split.refresh_from_db()
    runs = [trained_run(split, seed=seed, spoken=spoken) for seed, spoken in ((0, 0.5), (1, 0.9))]
    for run, known in zip(runs, (0.5, 0.01), strict=True):
        (unseen,) = run.evaluations.all()
        unseen.pk, unseen.part = None, "known"
        unseen.accuracy, unseen.interval_low, unseen.interval_high = known, known, known
        unseen.save()
    consider(runs[0])
    assert consider(runs[1]) is None
    assert promoted_run(split.world) == runs[0]


@pytest.fixture
def by_form(split):
    """A promoted run on a split by form that is right on half of the paraphrases of known forms, and on few others."""
    other = known_split(split.world, "by-form")
    Split.objects.filter(pk=other.pk).update(criterion="logical_form")
    run = trained_run(Split.objects.get(pk=other.pk), spoken=0.15)
    (known,) = run.evaluations.all()
    known.pk, known.part = None, "known"
    known.accuracy, known.interval_low, known.interval_high = 0.5, 0.4, 0.6
    known.save()
    promote(run, None)
    return run


def test_a_run_by_command_overtakes_one_by_form_that_is_less_sure_of_known_forms(split, by_form):
    assert consider(trained_run(split, spoken=0.45)) is None  # at least 35 %, and 40 % so far
    better = trained_run(split, seed=1, spoken=0.55)
    row = consider(better)
    assert (row.run, row.state) == (better, "promoted")
    assert "45.0 % on home, 40.0 % on by-form" in row.reason
    assert consider(trained_run(by_form.split, seed=1, spoken=0.95)) is None
    assert promoted_run(split.world) == better


def test_one_by_form_that_a_person_promoted_is_only_proposed_against(split, by_form, admin):
    roll = trained_run(by_form.split, seed=1, spoken=0.15)
    promote(roll, admin)
    assert consider(trained_run(split, spoken=0.9)).state == "proposed"
    assert promoted_run(split.world) == roll


def test_a_run_by_command_overtakes_one_that_was_asked_for_unseen_forms_alone(split, by_form):
    by_form.evaluations.filter(part="known").delete()
    better = trained_run(split, spoken=0.55)
    assert consider(better).run == better


@pytest.mark.parametrize(
    ("figures", "is_promoted"),
    [
        ({"para": (0.5, 100)}, True),
        ({"para": (0.49, 100)}, False),  # wrong more often than right
        ({"para": (0.9, 25), "gen": (0.16, 200)}, False),  # linear on a competition's sample
        ({"para": (0.9, 25), "gen": (0.98, 200)}, True),
        ({"said": (0.4, 20), "gen": (0.98, 200)}, False),
        ({"para": (1.0, 1)}, False),  # too few to judge by
        ({"para": (1.0, 1), "gen": (0.3, 200)}, False),
        ({"para": (0.0, 19), "gen": (0.8, 200)}, True),
        ({"gen": (0.8, 200)}, True),
        ({}, False),
    ],
)
def test_the_first_is_promoted_where_it_is_right_more_often_than_wrong(split, figures, is_promoted):
    run = trained_run(split, spoken=None)
    for source, (accuracy, count) in figures.items():
        score(run, accuracy, source)
        run.evaluations.filter(test_source=source).update(count=count)
    assert (consider(run) is not None) == is_promoted


@pytest.mark.parametrize("new", [0, 3, 4, 12])
def test_a_parser_that_writes_no_new_form_is_not_promoted_where_a_third_is_new(world, new):
    """Of twelve validation pairs ``new`` ask for forms that training does not have, the others for known ones."""
    split = known_split(world, "asked", new)
    known = split.examples.filter(part="train").values_list("logical_form", flat=True)
    for pk, form in zip(
        split.examples.filter(part="validation")
        .exclude(logical_form__startswith="( new")
        .values_list("pk", flat=True),
        sorted(set(known)),
        strict=False,
    ):
        split.examples.filter(pk=pk).update(logical_form=form)
    store_figures(split)
    run = trained_run(split, spoken=0.9)
    assert (consider(run) is not None) == (new < 4)
    Promotion.objects.all().delete()
    TrainingRun.objects.filter(pk=run.pk).update(parser="seq2seq")
    assert consider(run) is not None


def test_generated_commands_decide_where_people_said_too_little(split):
    first, second = (trained_run(split, seed=seed, spoken=None) for seed in (0, 1))
    for run, of_people, of_both in ((first, 1.0, 0.6), (second, 0.2, 0.8)):
        score(run, of_people)
        score(run, of_both, "mixed")
        score(run, of_both, "gen")
        run.evaluations.filter(test_source="para").update(count=5)
    consider(first)
    row = consider(second)
    assert row.run == second and "80.0" not in row.reason and "70.0 %" in row.reason


def test_no_run_of_the_oracle_is_promoted(split, admin):
    run = trained_run(split, spoken=1.0)
    TrainingRun.objects.filter(pk=run.pk).update(parser="grammar-oracle")
    run.refresh_from_db()
    assert consider(run) is None
    with pytest.raises(Refusal) as refused:
        promote(run, admin)
    assert refused.value.code == "needs_no_run"
    assert not Promotion.objects.exists()


def make_oracle(run: TrainingRun) -> None:
    """Make a promoted run one of the oracle, as installations of older versions may have."""
    TrainingRun.objects.filter(pk=run.pk).update(parser="grammar-oracle")


def test_a_promoted_oracle_is_no_learned_part_and_the_next_good_run_takes_its_place(split):
    oracle = trained_run(split)
    consider(oracle)
    assert learned_part(split.world) == oracle
    make_oracle(oracle)
    assert learned_part(split.world) is None
    better = trained_run(split, seed=1)
    assert consider(better).state == "promoted"
    assert learned_part(split.world) == better
    assert previous_run(split.world) is None


def test_where_a_person_promoted_the_oracle_a_learned_part_is_proposed(split, admin):
    oracle = trained_run(split)
    promote(oracle, admin)
    make_oracle(oracle)
    better = trained_run(split, seed=1)
    assert consider(better).state == "proposed"
    promote(better, admin)
    assert learned_part(split.world) == better


def test_the_first_does_not_wait_for_others_on_their_way(split):
    run_requests.request(split.world, split, "seq2seq", send=False)
    assert consider(trained_run(split)).state == "promoted"


def test_a_parser_that_asks_a_server_never_overtakes(split):
    consider(trained_run(split, spoken=0.5))
    asked = trained_run(split, seed=1, spoken=0.9)
    TrainingRun.objects.filter(pk=asked.pk).update(parser="llm")
    assert consider(asked).state == "proposed"


def test_a_run_on_a_share_of_the_pairs_does_not_count(split):
    run = trained_run(split)
    TrainingRun.objects.filter(pk=run.pk).update(train_share=0.5)
    assert consider(run) is None


def test_training_considers_the_run(world, transactional_db):
    split = make_split(world)
    known = split.examples.get(part="train", source="paraphrased", position=1)
    asked = split.examples.filter(part="validation")
    asked.update(utterance=known.utterance, logical_form=known.logical_form)
    store_figures(split)
    run, _ = run_requests.request(world, split, "knn", train_sources="gen+para", send=False)
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
    queued, _ = run_requests.request(split.world, split, "knn", seed=9, send=False)
    with pytest.raises(Refusal) as refused:
        promote(queued, admin)
    assert refused.value.code == "run_not_succeeded"
    run = trained_run(split)
    promote(run, admin)
    with pytest.raises(Refusal) as refused:
        promote(run, admin)
    assert refused.value.code == "promoted_already"
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
    with pytest.raises(Refusal) as refused:
        roll_back(split.world, admin)
    assert refused.value.code == "no_run_before"
    promote(runs[2], admin)
    assert previous_run(split.world) == runs[0]


def test_worlds_do_not_share_a_promotion(split, other_world):
    other = trained_run(make_split(other_world, "other"))
    promote(other, None)
    assert promoted_run(split.world) is None
    assert list(Promotion.objects.present()) == [other.promotions.get()]


def test_retraining_after_the_corpus_changed_is_proposed_where_it_is_not_clearly_worse(split):
    first = trained_run(split, spoken=0.6)
    consider(first)
    later = frozen_anew(split)
    row = consider(trained_run(later, spoken=0.55))
    assert row.state == "proposed"
    assert promoted_run(split.world) == first
    better = trained_run(later, seed=1, spoken=0.7)
    assert consider(better).state == "promoted"
    row.refresh_from_db()
    assert row.state == "overtaken"
    assert promoted_run(split.world) == better


def test_after_the_corpus_changed_what_a_person_promoted_is_only_proposed_against(split, admin):
    first = trained_run(split, spoken=0.6)
    promote(first, admin)
    later = frozen_anew(split)
    row = consider(trained_run(later, spoken=0.55))
    assert row.state == "proposed"
    assert "after the corpus changed since home: 55.0 % on validation paraphrases" in row.reason
    better = trained_run(later, seed=1, spoken=0.7)
    assert consider(better).state == "proposed"
    row.refresh_from_db()
    assert row.state == "overtaken" and row.decided_at is not None  # the history shows it
    assert consider(trained_run(later, seed=2, spoken=0.65)) is None
    assert promoted_run(split.world) == first
    assert promote(better, admin).reason.startswith("Trained on home-2")
    assert Promotion.objects.proposed().count() == 0


def test_nothing_is_proposed_on_the_same_corpus_or_where_it_is_clearly_worse(split):
    consider(trained_run(split, spoken=0.7))
    assert consider(trained_run(split, seed=1, spoken=0.65)) is None
    assert consider(trained_run(frozen_anew(split), spoken=0.55)) is None
    assert not Promotion.objects.proposed()


def test_a_proposal_is_declined_once(split, admin):
    consider(trained_run(split, spoken=0.5))
    row = consider(trained_run(frozen_anew(split), spoken=0.5))
    assert decline(split.world, row.pk, admin).state == "declined"
    with pytest.raises(Refusal) as refused:
        decline(split.world, row.pk, admin)
    assert refused.value.code == "proposal_decided"
