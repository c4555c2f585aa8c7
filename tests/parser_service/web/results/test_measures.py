"""What counts as right, and the figures of the paper beside ours."""

from __future__ import annotations

import re

import pytest

from annotations.models import Example, Split
from parser_service.models import Prediction
from parser_service.results.accuracy_cells import PLANS_NOT_COMPARED
from parser_service.results.accuracy_tables import accuracy_tables
from parser_service.results.measures import Measure
from parser_service.results.published import SIZES, published_accuracy, published_criteria
from tests.parser_service.web.results.conftest import equivalents
from tests.sample_world import scored_run


def test_a_split_of_the_published_sizes_is_known_as_published(world):
    split = Split.objects.create(
        world=world, name="w", criterion="command", content_hash="w", seed=None
    )
    Example.objects.bulk_create(
        Example(
            split=split,
            part=part,
            source=source,
            position=position,
            utterance="u",
            logical_form="f",
        )
        for (source, part), count in SIZES["command"].items()
        for position in range(count)
    )
    assert published_criteria([split]) == {split.pk: "command"}
    split.seed = 0
    assert published_criteria([split]) == {}


def test_published_figures_are_those_of_the_paper():
    assert published_accuracy("seq2seq", ("para", "para"), "command") == 64.4
    assert published_accuracy("knn", ("gen", "gen"), "logical_form") == 0.0
    assert published_accuracy("seq2seq", ("gen+para", "mixed"), "command") is None
    assert published_accuracy("seq2seq", ("gen", "gen"), "") is None


def test_equivalence_has_its_own_figure_interval_and_best(sample):
    equivalents(sample)
    scored_run(sample.world, sample.split, "seq2seq", right=11)
    both = (Measure.EXACT, Measure.EQUIVALENT)
    (table,) = accuracy_tables(sample.world, "validation", [sample.split], both)
    exact, equivalent = table.rows[0].cells[0].figures
    assert (exact.percent, equivalent.percent) == (25.0, 50.0)
    assert (exact.is_best, equivalent.is_best) == (False, False)
    assert equivalent.low < exact.percent < equivalent.high
    best, same = table.rows[1].cells[0].figures
    assert (best.is_best, same.is_best) == (True, True)
    assert "6 of 12 equivalent" in equivalent.note


def test_the_same_plan_has_its_own_figure_and_interval(sample):
    sample.run.evaluations.update(same_plan=0.25)
    every = (Measure.EXACT, Measure.EQUIVALENT, Measure.SAME_PLAN)
    (table,) = accuracy_tables(sample.world, "validation", [sample.split], every)
    *_, figure = table.rows[0].cells[0].figures
    assert (figure.percent, figure.measure) == (25.0, Measure.SAME_PLAN)
    assert figure.low < 25 < figure.high
    assert "3 of 12 same plan" in figure.note


def test_a_figure_by_plan_leads_to_the_answers_with_another_plan(sample, anna):
    wrong = sample.run.predictions.filter(is_exact_match=False).first()
    Prediction.objects.filter(pk=wrong.pk).update(is_same_plan=True)
    sample.run.evaluations.update(same_plan=4 / 12)
    (table,) = accuracy_tables(sample.world, "validation", [sample.split], (Measure.SAME_PLAN,))
    page = anna.get(table.rows[0].cells[0].url)
    others = sample.run.predictions.filter(is_same_plan=False, example__source="generated")
    assert page.context["listing"].total == others.count() > 0
    sample.run.evaluations.update(same_plan=1)
    (table,) = accuracy_tables(sample.world, "validation", [sample.split], (Measure.SAME_PLAN,))
    assert "outcome=" not in table.rows[0].cells[0].url


def test_a_column_with_a_plan_that_was_not_compared_has_no_best(sample):
    scored_run(sample.world, sample.split, "seq2seq", right=12)
    every = (Measure.EXACT, Measure.SAME_PLAN)
    (table,) = accuracy_tables(sample.world, "validation", [sample.split], every)
    assert [figure.is_best for figure in table.rows[1].cells[0].figures] == [True, True]
    sample.run.evaluations.update(same_plan=None)
    (table,) = accuracy_tables(sample.world, "validation", [sample.split], every)
    unknown, known = (row.cells[0].figures for row in table.rows)
    assert unknown[1] is None
    assert [figure.is_best for figure in known] == [True, False]
    (table,) = accuracy_tables(sample.world, "validation", [sample.split], (Measure.SAME_PLAN,))
    cell = table.rows[0].cells[0]
    assert (cell.percent, cell.is_best) == (None, False)
    assert PLANS_NOT_COMPARED in cell.note


def test_without_outcomes_by_cluster_the_interval_is_wilsons_and_nothing_is_best(sample):
    equivalents(sample)
    scored_run(sample.world, sample.split, "seq2seq", right=12)
    sample.run.evaluations.update(outcomes={})
    both = (Measure.EXACT, Measure.EQUIVALENT)
    (table,) = accuracy_tables(sample.world, "validation", [sample.split], both)
    _, equivalent = table.rows[0].cells[0].figures
    assert equivalent.low == pytest.approx(25.378, abs=0.01)  # of 6 of 12
    assert equivalent.high == pytest.approx(74.622, abs=0.01)
    assert not table.rows[1].cells[0].is_best


@pytest.mark.parametrize(
    ("measure", "shown"),
    [("exact", "25.0"), ("equivalent", "50.0"), ("all", "25.0"), ("well_formed", "100.0")],
)
def test_a_switch_says_what_counts_as_right(measure, shown, sample, anna):
    equivalents(sample)
    page = anna.get("/w/home/results/", {"measure": measure}).content.decode()
    assert f"<b>{shown}</b>" in page
    assert ("<b>50.0</b>" in page) == (measure in ("equivalent", "all"))


def test_several_measures_are_told_with_their_signs(sample, anna):
    page = anna.get("/w/home/results/", {"measure": "all"}).content.decode()
    assert "Exact match (✓), equivalent (≈) and same plan (→)" in page
    sample.run.evaluations.update(same_plan=None)
    page = anna.get("/w/home/results/", {"measure": "all"}).content.decode()
    unknown = page[page.index('aria-hidden="true">→</span>') :]
    assert re.match(r".*?same plan</span>\s*–", unknown, re.DOTALL)


def test_what_is_misspelled_is_the_default(sample, anna):
    page = anna.get("/w/home/results/", {"measure": "best", "published": "perhaps"})
    assert (page.context["choices"].measure, page.context["choices"].published) == ("exact", False)


def test_published_figures_are_shown_on_request(sample, anna, published):
    assert published == 63.0
    page = anna.get("/w/home/results/").content.decode()
    assert ">published 63.0<" not in page and "published=yes" in page
    page = anna.get("/w/home/results/", {"published": "yes"}).content.decode()
    assert ">published 63.0<" in page and "Walker, Peng and Cakmak (2019)" in page
    page = anna.get("/w/home/results/", {"published": "yes", "measure": "equivalent"})
    assert ">published " not in page.content.decode()
