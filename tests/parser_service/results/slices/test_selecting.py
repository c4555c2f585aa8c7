"""From a query to predictions and back: rows and columns choose the same ones."""

from __future__ import annotations

import numpy as np
import pytest
from django.db import connection

from annotations.models import Example
from parser_service.models import Slice
from parser_service.results.filter_conditions import NoColumn
from parser_service.results.saving import save_slice
from parser_service.results.selecting import filters_of, select, slice_query
from parser_service.results.stored_columns import answers_of, examples_of

IN_COLUMNS = {
    "outcome=correct": 6,
    "outcome=wrong": 6,
    "outcome=equivalent": 1,
    "outcome=same_plan": 8,
    "outcome=only_plan": 1,
    "outcome=other_plan": 3,
    "outcome=malformed": 1,
    "outcome=none": 1,
    "source=generated": 6,
    "source=generated&outcome=wrong": 3,
    "head=find": 4,
    "head=nothing_of_this_world": 0,
    "task_category=none+such": 0,
    "min_words=8": 6,
    "max_words=6": 1,
    "min_words=7&max_words=7": 5,
    "min_depth=3": 12,
    "max_depth=2": 0,
    "label=seen": 5,
    "label=new": 1,
    "answer_head=find": 4,
    "answer_head=bring": 4,
    "answer_head=UNKNOWN": 1,
    "answer_head=not+a+form": 2,
}
IN_ROWS = {
    "q=FETCH": 2,
    "category=wrong_predicate": 3,
    "category=wrong_predicate&category_by=people": 1,
    "category=wrong_predicate&category_by=machine": 2,
    "category=none": 3,
    "category=none&category_by=people": 5,
    "category=no+such+category": 0,
    "answer_form=UNKNOWN": 1,
    "answer_form=%28+go+%22+%3Croom%3E+%22+%29": 1,
    "answer_form=%28+go": 0,
}


def test_an_example_knows_its_shape_however_it_was_written(sample):
    texts = {
        "utterance": "bring me  tea",
        "logical_form": '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )',
    }
    place = {"split": sample.split, "part": "train", "source": "generated"}
    one = Example.objects.create(**place, **texts, position=1000)
    some = Example.objects.bulk_create([Example(**place, **texts, position=1001)])
    for row in Example.objects.filter(pk__in=[one.pk, some[0].pk]):
        assert (row.head_predicate, row.depth, row.word_count) == ("bring", 3, 3)
    broken = Example.objects.create(**place, utterance="", logical_form="( go", position=1002)
    assert (broken.head_predicate, broken.depth, broken.word_count) == ("", 0, 0)


@pytest.mark.parametrize("query", IN_COLUMNS | IN_ROWS)
def test_a_query_chooses_predictions(query, varied):
    assert select(varied.run, query).count() == (IN_COLUMNS | IN_ROWS)[query]


@pytest.mark.parametrize("query", IN_COLUMNS)
def test_columns_choose_the_examples_that_rows_choose(query, varied):
    examples = examples_of(varied.split, "validation")
    columns = {**examples.columns, **answers_of(varied.run, "validation", examples)}
    mask = np.ones(len(examples.keys), dtype=bool)
    for condition in filters_of(varied.world, query).conditions():
        mask &= condition.mask(columns)
    chosen = select(varied.run, query).order_by("example_id").values_list("example", flat=True)
    assert examples.keys[mask].tolist() == list(chosen)


@pytest.mark.parametrize("query", IN_ROWS)
def test_what_no_column_holds_is_said_so(query, varied):
    examples = examples_of(varied.split, "validation")
    with pytest.raises(NoColumn):
        for condition in filters_of(varied.world, query).conditions():
            condition.mask(examples.columns)


@pytest.mark.skipif(connection.vendor != "sqlite", reason="a planner scans so few rows")
def test_a_form_is_looked_up_by_its_length(varied):
    plan = select(varied.run, "answer_form=UNKNOWN").order_by().explain()
    assert "answers_by_length (run_id=? AND rank=? AND <expr>=?)" in plan


def test_another_run_of_the_same_example_is_a_filter(varied, second_run):
    wrong_there = select(varied.run, f"versus={second_run.pk}&versus_outcome=wrong")
    keys = second_run.predictions.filter(is_exact_match=False).values_list("example", flat=True)
    assert set(wrong_there.values_list("example", flat=True)) == set(keys)


def test_a_run_of_another_world_is_not_looked_into(varied, other_sample):
    assert not select(varied.run, f"versus={other_sample.run.pk}").exists()


@pytest.mark.parametrize(
    "query",
    ["outcome=splendid", "min_words=many", "min_words=-1", "max_depth=99999999999", "source=x",
     "head=%00", "slice=7", "slice=x", "category=%ED%A0%80", "nonsense=1", "label=", "versus=x"],
)  # fmt: skip
def test_what_a_filter_does_not_know_is_left_out(query, varied):
    assert select(varied.run, query).count() <= 12
    assert "outcome" not in slice_query(varied.world, query)


@pytest.mark.parametrize("query", [*IN_COLUMNS, *IN_ROWS])
def test_a_query_comes_back_as_it_was(query, varied):
    written = slice_query(varied.world, query)
    assert slice_query(varied.world, written) == written
    assert set(select(varied.run, written)) == set(select(varied.run, query))


def test_a_slice_forgets_what_belongs_to_the_page(varied):
    query = "max_words=6&part=validation&versus=3&sort=score&after=x&outcome=wrong"
    assert slice_query(varied.world, query) == "outcome=wrong&max_words=6"


def test_a_saved_slice_is_a_filter_of_its_own(varied):
    saved = save_slice(varied.world, "short errors", "outcome=wrong&max_words=6")
    chosen = select(varied.run, f"slice={saved.pk}")
    assert set(chosen) == set(select(varied.run, saved.query))
    further = select(varied.run, f"slice={saved.pk}&source=generated")
    assert set(further) == set(chosen.filter(example__source="generated"))


def test_a_slice_within_a_slice_is_written_out(varied):
    saved = save_slice(varied.world, "short errors", "outcome=wrong&max_words=6")
    query = slice_query(varied.world, f"slice={saved.pk}&max_words=5")
    assert query == "outcome=wrong&max_words=5"


def test_a_slice_of_another_world_is_not_known(varied, other_world):
    saved = Slice.objects.create(world=other_world, name="theirs", query="outcome=wrong")
    assert select(varied.run, f"slice={saved.pk}").count() == 12


def test_predictions_alone_do_not_say_which_world_is_meant(varied):
    with pytest.raises(ValueError):
        select(varied.run.predictions.best(), "outcome=wrong")
