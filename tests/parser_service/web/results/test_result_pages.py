"""The accuracy tables: what stands in which cell, what is best, what is on its way."""

from __future__ import annotations

import csv
import io
import re
from statistics import mean, stdev

import pytest
from django.db.models import F

from annotations.models import Split
from parser_service.analysis.outcomes import outcomes_of
from parser_service.analysis.scores import Judgement
from parser_service.models import TrainingRun
from parser_service.results.accuracy_tables import accuracy_tables
from parser_service.runs import run_requests
from tests.parser_service.made_up import make_split
from tests.parser_service.web.results.conftest import seeds
from tests.sample_world import scored_run


def tables(sample, part="validation", splits=None):
    return accuracy_tables(sample.world, part, splits or [sample.split])


def test_a_cell_shows_percent_and_interval_and_leads_to_its_wrong_answers(sample, anna):
    (table,) = tables(sample)
    cell = table.rows[0].cells[0]
    assert (cell.percent, cell.low, cell.high, cell.spread) == (25.0, 10.0, 60.0, None)
    assert cell.url == (
        f"/w/home/review/?run={sample.run.pk}&part=validation&outcome=wrong&source=generated"
    )
    page = anna.get(cell.url)
    assert not any(row.is_exact_match for row in page.context["listing"].rows)
    assert page.context["case"].answers[0].is_wrong


def test_where_all_answers_are_right_all_are_shown(sample):
    sample.run.evaluations.update(correct=F("count"), accuracy=1)
    assert "outcome" not in tables(sample)[0].rows[0].cells[0].url


def test_the_interval_is_shown_as_it_is_and_not_as_if_it_were_symmetric(sample, anna):
    sample.run.evaluations.update(accuracy=0, interval_low=0, interval_high=0.024)
    page = anna.get("/w/home/results/").content.decode()
    assert "0.0–2.4" in page
    assert "±1.2" not in page


def test_every_head_explains_itself(sample, anna):
    page = anna.get("/w/home/results/").content.decode()
    words = "Trained on generated commands, tested on generated commands: gen → gen"
    assert f'<abbr title="{words}">' in page
    assert "<span>trained on generated,</span> <span>tested on generated</span>" in page
    assert all(table.sentence in page for table in anna.get("/w/home/results/").context["tables"])


def test_hyperparameters_that_were_changed_are_named(sample, anna):
    run = scored_run(sample.world, sample.split, "seq2seq")
    changes = {**run.config, "epochs": 3, "dropout": 0.5}
    TrainingRun.objects.filter(pk=run.pk).update(config=changes)
    page = anna.get("/w/home/results/").content.decode()
    assert ">epochs 3, dropout 0.5</span>" in page or ">dropout 0.5, epochs 3</span>" in page


@pytest.mark.parametrize(("right", "is_best"), [(5, False), (11, True)])
def test_what_is_better_than_the_rest_of_a_column_beyond_chance_is_marked(sample, right, is_best):
    scored_run(sample.world, sample.split, "seq2seq", right=right)
    (table,) = tables(sample)
    assert [(row.parser, row.cells[0].is_best) for row in table.rows] == [
        ("knn", False),
        ("seq2seq", is_best),
    ]


def test_a_parser_alone_in_its_column_is_not_the_best(sample):
    (table,) = tables(sample)
    assert not table.rows[0].cells[0].is_best


def test_nothing_right_is_not_the_best(sample):
    sample.run.evaluations.update(accuracy=0)
    (table,) = tables(sample)
    assert not table.rows[0].cells[0].is_best


@pytest.fixture
def two_protocols(sample):
    run = scored_run(sample.world, sample.split, "seq2seq", right=11)
    TrainingRun.objects.filter(pk=run.pk).update(protocol="grammar")
    return sample


def test_figures_of_two_protocols_are_never_compared(two_protocols):
    shown = tables(two_protocols)
    assert [table.protocol for table in shown] == ["strict", "grammar"]
    assert not any(table.rows[0].cells[0].is_best for table in shown)


def test_all_protocols_stand_in_one_table_each_in_a_group_of_its_own(two_protocols, anna):
    page = anna.get("/w/home/results/").content.decode()
    assert page.count('class="accuracy-table"') == 1
    assert re.findall(r'scope="rowgroup" id="protocol-(\w+)"', page) == ["strict", "grammar"]


def test_other_hyperparameters_are_another_row(sample):
    run = scored_run(sample.world, sample.split, "seq2seq")
    TrainingRun.objects.filter(pk=run.pk).update(config={**run.config, "epochs": 3})
    run_requests.request(sample.world, sample.split, "seq2seq", seed=1, send=False)
    (table,) = tables(sample)
    assert [(row.parser, row.changes) for row in table.rows] == [
        ("knn", ()),
        ("seq2seq", ()),
        ("seq2seq", (("epochs", 3),)),
    ]


def seq2seq_cell(sample):
    (table,) = tables(sample)
    return table.rows[-1].cells[0]


def test_several_seeds_show_their_mean_and_spread_and_lead_to_their_runs(sample, anna):
    runs = seeds(sample, 2, 3, 7)
    count = runs[0].evaluations.get().count
    shares = [right / count for right in (2, 3, 7)]
    cell = seq2seq_cell(sample)
    assert cell.n_seeds == 3
    assert cell.percent == pytest.approx(100 * mean(shares))
    assert cell.spread == pytest.approx(100 * stdev(shares))
    assert all(part in cell.note for part in ("3 seeds", "95 %", " 22.0", "16.7 to 58.3"))
    listed = anna.get(cell.url).context["listing"].rows
    assert {run.pk for run in listed} == {run.pk for run in runs}


def test_the_seeds_are_said_in_words_and_one_run_says_nothing_of_them(sample, anna):
    page = anna.get("/w/home/results/table/").content.decode()
    assert "mean of </span>" not in page
    seeds(sample, 2, 3, 7)
    page = anna.get("/w/home/results/table/").content.decode()
    assert "mean of </span>3 seeds," in page
    assert "σ</span>" in page


def test_the_best_of_a_column_is_the_best_mean(sample):
    seeds(sample, 11, 12)
    scored_run(sample.world, sample.split, "ranker", right=4)
    (table,) = tables(sample)
    assert [row.cells[0].is_best for row in table.rows] == [False, True, False]


def by_form(sample, right=6, known=9):
    """The split of the sample as if by form, and the score of its run on known forms."""
    Split.objects.filter(pk=sample.split.pk).update(criterion="logical_form")
    sample.split.refresh_from_db()
    sample.run.evaluations.update(accuracy=right / 12, correct=right)
    (score,) = sample.run.evaluations.all()
    judgements = [Judgement(n < right, n < right, True) for n in range(12)]
    score.outcomes = outcomes_of([f"form {n // 2}" for n in range(12)], judgements)
    score.save()
    score.pk, score.part, score.correct, score.accuracy = None, "known", known, known / 12
    judgements = [Judgement(n < known, n < known, True) for n in range(12)]
    score.outcomes = outcomes_of([f"other {n // 2}" for n in range(12)], judgements)
    score.save()


def test_by_form_a_cell_shows_the_harmonic_mean_and_both_that_it_is_of(sample, anna):
    by_form(sample)
    (figure,) = tables(sample)[0].rows[0].cells[0].figures
    assert figure.percent == pytest.approx(60.0)
    assert [(part.label, part.percent) for part in figure.parts] == [("unseen", 50), ("known", 75)]
    assert figure.low < 60 < figure.high
    page = " ".join(anna.get("/w/home/results/").content.decode().split())
    assert "<b>60.0</b>" in page
    assert "unseen&nbsp;50.0 · known&nbsp;75.0" in page
    (row,) = csv.DictReader(io.StringIO(anna.get("/w/home/results.csv").content.decode()))
    assert [float(row[name]) for name in ("percent", "unseen", "known")] == pytest.approx(
        [60, 50, 75]
    )
    assert "unseen 50.0, known 75.0" in anna.get("/w/home/results.tex").content.decode()


def test_unseen_forms_never_stand_alone_without_a_word(sample, anna):
    by_form(sample)
    sample.run.evaluations.filter(part="known").delete()
    (figure,) = tables(sample)[0].rows[0].cells[0].figures
    assert (figure.alone, figure.percent) == (True, 50.0)
    assert figure.note in anna.get("/w/home/results/").content.decode()


def test_other_hyperparameters_and_protocols_are_not_seeds_of_one_cell(sample):
    _, other, third = seeds(sample, 2, 3, 4)
    TrainingRun.objects.filter(pk=other.pk).update(config={**other.config, "epochs": 3})
    TrainingRun.objects.filter(pk=third.pk).update(protocol="grammar")
    cells = [row.cells[0] for table in tables(sample) for row in table.rows]
    assert [cell.n_seeds for cell in cells] == [1, 1, 1, 1]


def test_of_a_seed_that_was_trained_twice_the_newest_run_counts(sample):
    old, new = seeds(sample, 2, 4)
    TrainingRun.objects.filter(pk=new.pk).update(seed=old.seed)
    assert seq2seq_cell(sample).scores == (new.evaluations.get(),)


def test_versions_of_a_parser_are_not_averaged(sample, anna):
    old, *new = seeds(sample, 2, 3, 4)
    TrainingRun.objects.filter(pk=old.pk).update(parser_version=0)
    cell = seq2seq_cell(sample)
    assert cell.n_seeds == 2
    listed = anna.get(cell.url).context["listing"].rows
    assert {run.pk for run in listed} == {run.pk for run in new}


def test_seeds_that_wait_show_as_one_and_lead_to_all_of_them(sample, anna):
    asked = run_requests.request_seeds(
        sample.world, sample.split, "seq2seq", seeds=(3, 4), send=False
    )
    TrainingRun.objects.filter(pk=asked[0][0].pk).update(status="running", progress=0.5)
    cell = seq2seq_cell(sample)
    assert (cell.status, cell.progress_percent, cell.percent) == ("running", 25.0, None)
    assert anna.get(cell.url).context["listing"].total == 2
    scored_run(sample.world, sample.split, "seq2seq", seed=5)
    assert "2 " in seq2seq_cell(sample).note.rpartition(";")[2]


def test_a_run_at_work_shows_its_progress(sample):
    run, _ = run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    TrainingRun.objects.filter(pk=run.pk).update(status="running", progress=0.3)
    (table,) = tables(sample)
    cell = table.rows[1].cells[0]
    assert (cell.status, cell.progress_percent, cell.percent) == ("running", 30.0, None)
    assert cell.url == f"/w/home/runs/{run.pk}/"
    assert table.is_active


@pytest.mark.parametrize("status", ["failed", "cancelled", "lost"])
def test_what_came_to_nothing_is_not_in_the_table(status, sample):
    TrainingRun.objects.update(status=status)
    assert tables(sample) == []


def test_columns_are_the_settings_that_somebody_trained(sample):
    run_requests.request(
        sample.world, sample.split, "seq2seq", train_sources="gen+para", send=False
    )
    (table,) = tables(sample)
    assert [column.setting for column in table.columns] == [
        ("gen", "gen"),
        ("gen", "para"),
        ("gen+para", "para"),
        ("gen+para", "mixed"),
    ]


def test_columns_are_named_by_criterion_where_that_tells_them_apart(sample):
    other = make_split(sample.world, "other")
    run_requests.request(sample.world, other, "knn", send=False)
    both = [sample.split, other]
    assert {column.label for column in tables(sample, splits=both)[0].columns} == {
        "home-split",
        "other",
    }
    Split.objects.filter(pk=other.pk).update(criterion="logical_form")
    both[1].refresh_from_db()
    assert {column.label for column in tables(sample, splits=both)[0].columns} == {
        "command",
        "form",
    }


def test_the_tables_cost_three_queries(sample, django_assert_num_queries):
    for seed in range(6):
        run_requests.request(sample.world, sample.split, "seq2seq", seed=seed, send=False)
    with django_assert_num_queries(3):
        tables(sample)


def test_scored_seeds_cost_no_query_each(sample, django_assert_num_queries):
    seeds(sample, 1, 2, 3, 4)
    with django_assert_num_queries(3):
        assert seq2seq_cell(sample).n_seeds == 4


def test_the_page_shows_the_part_that_was_scored(sample, anna):
    page = anna.get("/w/home/results/")
    assert page.context["part"] == "validation"
    assert "25.0" in page.content.decode()
    page = anna.get("/w/home/results/", {"part": "test"})
    assert page.context["part"] == "test"
    assert not page.context["is_scored"] and '<p role="status">' in page.content.decode()
    assert anna.get("/w/home/results/", {"part": "train"}).context["part"] == "validation"


def test_an_empty_page_says_what_would_be_there(world, anna, adam):
    for browser, may_start in ((anna, False), (adam, True)):
        page = browser.get("/w/home/results/").content.decode()
        assert '<div class="empty">' in page
        assert ('class="primary" href="/w/home/runs/new/' in page) is may_start


def test_a_run_on_a_share_of_the_pairs_is_in_no_table(sample):
    TrainingRun.objects.update(train_share=0.25)
    assert tables(sample) == []


def test_a_column_leads_to_its_learning_curves(sample, anna):
    page = anna.get("/w/home/results/").content.decode()
    query = "split=home-split&amp;setting=gen-gen&amp;protocol=strict&amp;part=validation"
    assert f'href="/w/home/results/curves/?{query}"' in page


def test_what_people_said_and_models_wrote_have_columns_once_they_are_scored(sample):
    paper = [column.setting for column in tables(sample)[0].columns]
    assert ("gen", "said") not in paper
    score = sample.run.evaluations.first()
    for source in ("said", "model"):
        score.pk, score.test_source = None, source
        score.save()
    columns = tables(sample)[0].columns
    at = {column.setting: place for place, column in enumerate(columns)}
    assert set(at) == {*paper, ("gen", "said"), ("gen", "model")}
    assert at["gen", "para"] < at["gen", "model"] < at["gen", "said"]
    cells = tables(sample)[0].rows[0].cells
    for source in ("said", "model"):
        assert cells[at["gen", source]].url.endswith(f"source={source}")
