"""Which runs may be asked for, and which are there already."""

from __future__ import annotations

import pytest

from annotations.background import send_wake_up
from annotations.language.texts.errors import Refusal
from annotations.models import Entity, Ontology
from parser_service.models import TrainingRun
from parser_service.runs import lifecycle, run_requests
from tests.parser_service.made_up import make_split
from tests.parser_service.requests import ask, at_once, claim


def test_what_decides_the_result_is_trained_once(split):
    first, is_new = run_requests.request(split.world, split, "knn", seed=1)
    again, is_new_again = run_requests.request(split.world, split, "knn", seed=1)
    assert (is_new, is_new_again) == (True, False)
    assert again == first


@pytest.mark.parametrize(
    "changes",
    [
        {"seed": 2},
        {"train_sources": "gen+para"},
        {"config": {"least_overlap": 0.5}},
        {"parser": "grammar-oracle", "protocol": "grammar"},
        {"train_share": 0.25},
    ],
)
def test_anything_that_decides_the_result_makes_another_run(split, changes):
    assert ask(split, seed=1) != ask(split, **{"seed": 1, **changes})


def test_a_default_that_is_written_out_is_the_same_run(split):
    assert ask(split) == ask(split, config={"least_overlap": 0.0})


def test_other_examples_are_another_run(split):
    other = make_split(split.world, "away")
    assert ask(split) != ask(other)


def test_an_edit_of_the_world_counts_only_where_the_protocol_reads_it(split):
    strict = ask(split)
    oracle = ask(split, parser="grammar-oracle", protocol="grammar")
    ontology = Ontology.objects.create(world=split.world)
    Entity.objects.create(ontology=ontology, entity_class="object", text="cup", position=0)
    assert ask(split) == strict
    assert ask(split, parser="grammar-oracle", protocol="grammar") != oracle


def test_a_failed_run_may_be_asked_for_again(split):
    first = ask(split)
    lifecycle.fail(claim(), "It broke. Mend it.")
    assert ask(split) != first


@pytest.mark.parametrize(
    ("changes", "named", "code"),
    [
        ({"parser": "oracle"}, "'oracle'", "unknown_parser"),
        ({"protocol": "grammar"}, "knn .*'grammar'.* strict", "unknown_protocol"),
        ({"train_sources": "all"}, "'all'", "unknown_train_sources"),
        (
            {"config": {"least_overlap": 2.0}},
            r"least_overlap .*\b2\.0\b.* 1\b",
            "hyperparameter_out_of_range",
        ),
        ({"config": {"k": 1}}, r"\bk\b", "unknown_hyperparameter"),
        ({"seed": -1}, r" -1\b", "seeds_out_of_range"),
    ],
)
def test_what_cannot_be_trained_is_refused_with_what_is_wrong(split, changes, named, code):
    with pytest.raises(Refusal, match=named) as refused:
        ask(split, **changes)
    assert refused.value.code == code
    assert not TrainingRun.objects.exists()


def test_several_seeds_are_one_request(split):
    first = ask(split, seed=5)
    answers = run_requests.request_seeds(split.world, split, "knn", seeds=(4, 5, 6), send=False)
    assert [(run.seed, is_new) for run, is_new in answers] == [(4, True), (5, False), (6, True)]
    assert answers[1][0] == first


def test_of_several_seeds_all_are_queued_or_none(split):
    seeds = (run_requests.LARGEST_SEED, run_requests.LARGEST_SEED + 1)
    with pytest.raises(Refusal, match=f"{seeds[1]}") as refused:
        run_requests.request_seeds(split.world, split, "knn", seeds=seeds, send=False)
    assert refused.value.code == "seeds_out_of_range"
    assert not TrainingRun.objects.exists()


@pytest.mark.parametrize(
    ("first", "count", "wrong"), [(0, 0, "0"), (0, 11, "11"), (2**32 - 1, 2, f"{2**32}")]
)
def test_seeds_that_there_are_not_are_refused(first, count, wrong):
    with pytest.raises(Refusal, match=rf"\b{wrong}\b") as refused:
        run_requests.seeds_from(first, count)
    assert refused.value.code == "seeds_out_of_range"


def test_a_split_of_another_world_is_refused(split, other_world):
    with pytest.raises(Refusal) as refused:
        run_requests.request(other_world, split, "knn")
    assert refused.value.code == "split_of_another_world"


def test_train_sources_without_examples_are_refused(split):
    split.examples.filter(source="paraphrased").delete()
    with pytest.raises(Refusal) as refused:
        ask(split, train_sources="gen+para")
    assert refused.value.code == "no_training_examples"


def test_a_worker_is_woken_when_the_request_is_stored_and_not_before(
    split, django_capture_on_commit_callbacks
):
    with django_capture_on_commit_callbacks() as waiting:
        ask(split)
    assert [callback.func for callback in waiting] == [send_wake_up]
    with django_capture_on_commit_callbacks() as waiting:
        ask(split)
    assert waiting == []


@pytest.mark.django_db(transaction=True)
def test_of_many_who_ask_for_the_same_all_get_one_run(split):
    asked = at_once(lambda _: run_requests.request(split.world, split, "knn", send=False))
    assert len({run.pk for run, _ in asked}) == 1
    assert sum(is_new for _, is_new in asked) == 1


def test_runs_on_all_pairs_keep_the_keys_that_they_had_before_there_were_shares(split):
    run, _ = run_requests.request(split.world, split, "knn", train_share=1.0)
    before = "ead3fd28369b9aab7f55ac7cff7a781547656caa91e6362886dfe6261eca3184"
    assert run.content_key == before
    assert ask(split) == run


@pytest.mark.parametrize("share", [0, 0.001, -1, 1.01])
def test_a_share_that_there_is_not_is_refused(share, split):
    with pytest.raises(Refusal, match=rf"{share:g}\b.*\b0\.01\b.*\b1\b") as refused:
        run_requests.request(split.world, split, "knn", train_share=share)
    assert refused.value.code == "share_out_of_range"
