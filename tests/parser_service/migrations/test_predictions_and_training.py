"""What a database gets that was used before predictions stored where their forms are from."""

from __future__ import annotations

from importlib import import_module

import pytest
from django.apps import apps
from django.db import connection

from parser_service.models import Prediction, TrainingRun
from tests.parser_service.made_up import make_split
from tests.sample_world import answer, scored_run

migration = import_module("parser_service.migrations.0007_predictions_and_training")
FACTS = ("answer_in_training", "label_in_training", "origin")
KNOWN = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'


def fill() -> None:
    migration.fill(apps, connection.schema_editor())


@pytest.fixture
def run(world) -> TrainingRun:
    """A run of knn on generated pairs, as an older version stored it."""
    return scored_run(world, make_split(world))


def facts(run: TrainingRun, form: str) -> tuple[int | None, int, str]:
    return run.predictions.filter(logical_form=form).values_list(*FACTS).first()


def trained_with(run: TrainingRun, form: str, *sources: str) -> int:
    return run.split.examples.filter(part="train", source__in=sources, logical_form=form).count()


def test_the_counts_are_those_of_the_training_pairs_of_the_run(run, monkeypatch):
    monkeypatch.setattr(migration, "AT_ONCE", 5)
    shared = run.predictions.first().example.logical_form
    for position in (0, 1):
        run.split.examples.filter(part="train", position=position).update(logical_form=shared)
    fill()
    rows = list(run.predictions.select_related("example"))
    assert len(rows) == 12
    for row in rows:
        label = row.example.logical_form
        assert row.answer_in_training == trained_with(run, row.logical_form, "generated")
        assert row.label_in_training == trained_with(run, label, "generated")
    assert max(row.label_in_training for row in rows) > 1


def test_both_sources_count_where_a_run_learned_from_both(run):
    TrainingRun.objects.update(train_sources="gen+para")
    example = run.split.examples.filter(part="test").first()
    answer(run, example, KNOWN)
    fill()
    both = trained_with(run, KNOWN, "generated", "paraphrased")
    assert facts(run, KNOWN)[0] == both > trained_with(run, KNOWN, "generated")


@pytest.mark.parametrize(
    ("parser", "kind", "of_known", "of_new"),
    [
        ("knn", "similarity", "training", "validation"),
        ("ranker", "log_probability", "training", ""),
        ("seq2seq", "log_probability", "training", ""),
        ("grammar-oracle", "", "grammar", "grammar"),
        ("no-longer-there", "", "training", ""),
    ],
)
def test_origin_and_kind_of_score_follow_from_the_parser(parser, kind, of_known, of_new, run):
    TrainingRun.objects.update(parser=parser)
    answer(run, run.split.examples.filter(part="test").first(), KNOWN)
    fill()
    run.refresh_from_db()
    assert run.score_kind == kind
    assert facts(run, KNOWN)[2] == of_known
    assert facts(run, '( go " <room> " )') == (0, facts(run, '( go " <room> " )')[1], of_new)


def test_no_answer_has_no_count_and_no_origin(run):
    answer(run, run.split.examples.filter(part="test").first(), "")
    fill()
    seen, _, origin = facts(run, "")
    assert (seen, origin) == (None, "")


def test_what_is_filled_already_stays(run):
    one = run.predictions.first()
    Prediction.objects.filter(pk=one.pk).update(
        answer_in_training=7, label_in_training=8, origin="x"
    )
    fill()
    one.refresh_from_db()
    assert (one.answer_in_training, one.label_in_training, one.origin) == (7, 8, "x")
