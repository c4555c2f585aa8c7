"""Predictions and accuracies of a trained parser."""

from __future__ import annotations

from collections import Counter

import pytest

from annotations.models import Example
from parser_service.models import TrainingRun
from tests.parser_service.made_up import TINY, make_split
from tests.parser_service.runs.test_train_run import trained


@pytest.fixture
def split(world, transactional_db):
    return make_split(world)


def figures(run: TrainingRun) -> dict[tuple[str, str], tuple[int, int]]:
    rows = run.evaluations.all()
    return {(row.part, row.test_source): (row.correct, row.count) for row in rows}


def test_both_parts_are_scored_on_generated_paraphrased_and_both(split):
    by_part = figures(trained(split))
    assert {key: count for key, (_, count) in by_part.items()} == {
        ("validation", "gen"): 6,
        ("validation", "para"): 6,
        ("validation", "mixed"): 12,
        ("test", "gen"): 6,
        ("test", "para"): 6,
        ("test", "mixed"): 12,
    }
    for part in ("validation", "test"):
        assert by_part[part, "mixed"][0] == by_part[part, "gen"][0] + by_part[part, "para"][0]


def test_a_part_or_source_without_examples_has_no_figure(split):
    split.examples.filter(part="test").delete()
    split.examples.filter(source="paraphrased").delete()
    assert set(figures(trained(split))) == {("validation", "gen")}


def test_candidates_are_ranked_and_judged_against_the_annotated_form(split):
    run = trained(split, train_sources="gen+para")
    for example in Example.objects.exclude(part="train"):
        rows = list(run.predictions.filter(example=example).order_by("rank"))
        assert [row.rank for row in rows] == list(range(1, len(rows) + 1))
        assert [row.score for row in rows] == sorted((row.score for row in rows), reverse=True)
        for row in rows:
            assert row.is_exact_match == (row.logical_form == example.logical_form)
            assert row.is_well_formed


def test_an_example_without_an_answer_has_one_row_with_an_empty_form(split):
    split.examples.filter(part="validation").update(utterance="xyzzy")
    run = trained(split, config={"least_overlap": 0.5})
    rows = run.predictions.filter(example__part="validation")
    assert rows.count() == 12
    for row in rows:
        assert (row.rank, row.logical_form, row.is_exact_match) == (1, "", False)
        assert not row.is_well_formed


def test_the_nearest_neighbour_consults_validation_pairs_for_the_test_part_only(split):
    """The test example is a validation one in other words; only there is its form to be found."""
    form = '( guide ( lambda $1 e ( is_a $1 " <name> " ) ) )'
    for part in ("validation", "test"):
        chosen = split.examples.filter(part=part, source="generated")
        chosen.filter(pk=chosen.first().pk).update(utterance="guide <name>", logical_form=form)
    run = trained(split)
    right = run.predictions.best().filter(example__utterance="guide <name>")
    assert dict(right.values_list("example__part", "is_exact_match")) == {
        "validation": False,
        "test": True,
    }


def test_the_interval_holds_the_accuracy(split):
    for row in trained(split).evaluations.all():
        assert 0 <= row.interval_low <= row.accuracy <= row.interval_high <= 1
        assert row.accuracy == row.correct / row.count


def test_predictions_say_how_often_training_had_their_forms(split):
    run = trained(split, train_sources="gen+para")
    counts = Counter(
        split.examples.filter(part="train").order_by().values_list("logical_form", flat=True)
    )
    rows = list(run.predictions.select_related("example"))
    assert max(row.answer_in_training for row in rows) > 1
    for row in rows:
        assert row.answer_in_training == counts[row.logical_form]
        assert row.label_in_training == counts[row.example.logical_form]


def test_only_the_sources_that_a_run_learned_from_are_counted(split):
    run = trained(split, train_sources="gen")
    row = run.predictions.best().first()
    learned = split.examples.filter(part="train", source="generated", logical_form=row.logical_form)
    assert row.answer_in_training == learned.count()


def test_predictions_say_what_their_score_is_made_of_and_where_their_form_is_from(split):
    run = trained(split)
    assert run.score_kind == "similarity"
    for row in run.predictions.all():
        assert row.origin == ("training" if row.answer_in_training else "validation")
        assert row.score_parts["similarity"] == pytest.approx(row.score, abs=1e-4)


def test_a_form_of_unknown_origin_that_training_has_is_from_training(split):
    run = trained(split, "seq2seq", config={**TINY, "epochs": 2, "patience": 2})
    assert run.score_kind == "log_probability"
    for row in run.predictions.all():
        assert row.origin == ("training" if row.answer_in_training else "")
        assert row.score_parts["tokens"] >= 0


def test_no_answer_has_no_count(split):
    split.examples.filter(part="validation").update(utterance="xyzzy")
    run = trained(split, config={"least_overlap": 0.5})
    rows = run.predictions.filter(example__part="validation")
    for row in rows:
        assert (row.answer_in_training, row.origin, row.score_parts) == (None, "", {})
