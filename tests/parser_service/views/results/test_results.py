"""The accuracy tables: what stands in which cell, what is best, what is on its way."""

from __future__ import annotations

import csv
import io
import re
import subprocess
from shutil import which
from statistics import mean, stdev

import pytest
from django.db.models import F

from annotations.models import Example, Split
from parser_service.models import TrainingRun
from parser_service.results.accuracy import accuracy_tables
from parser_service.results.latex import escape
from parser_service.results.measures import Measure
from parser_service.results.published import SIZES, published_accuracy, published_criteria
from parser_service.runs import requesting
from tests.parser_service.made_up import make_split
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
    words = "Trained on generated commands, tested on generated commands"
    assert f'<abbr title="{words}">gen → gen</abbr>' in page
    assert "no two parts share a command" in page


def test_hyperparameters_that_were_changed_are_named(sample, anna):
    run = scored_run(sample.world, sample.split, "seq2seq")
    changes = {**run.config, "epochs": 3, "dropout": 0.5}
    TrainingRun.objects.filter(pk=run.pk).update(config=changes)
    page = anna.get("/w/home/results/").content.decode()
    assert ">epochs 3, dropout 0.5</span>" in page or ">dropout 0.5, epochs 3</span>" in page


def test_the_best_of_a_column_is_marked(sample):
    scored_run(sample.world, sample.split, "seq2seq", right=5)
    (table,) = tables(sample)
    assert [(row.parser, row.cells[0].is_best) for row in table.rows] == [
        ("knn", False),
        ("seq2seq", True),
    ]


def test_nothing_right_is_not_the_best(sample):
    sample.run.evaluations.update(accuracy=0)
    (table,) = tables(sample)
    assert not table.rows[0].cells[0].is_best


def test_protocols_never_share_a_table(sample):
    TrainingRun.objects.filter(pk=scored_run(sample.world, sample.split, "seq2seq").pk).update(
        protocol="grammar"
    )
    assert [table.protocol for table in tables(sample)] == ["strict", "grammar"]


def test_other_hyperparameters_are_another_row(sample):
    run = scored_run(sample.world, sample.split, "seq2seq")
    TrainingRun.objects.filter(pk=run.pk).update(config={**run.config, "epochs": 3})
    requesting.request(sample.world, sample.split, "seq2seq", seed=1, send=False)
    (table,) = tables(sample)
    assert [(row.parser, row.changes) for row in table.rows] == [
        ("knn", ()),
        ("seq2seq", ()),
        ("seq2seq", (("epochs", 3),)),
    ]


def seeds(sample, *right):
    """Runs of seq2seq with seeds 0, 1, … of which so many answers are right."""
    return [
        scored_run(sample.world, sample.split, "seq2seq", each, seed)
        for seed, each in enumerate(right)
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
    assert "Mean of 3 seeds ± standard deviation" in cell.note
    listed = anna.get(cell.url).context["listing"].rows
    assert {run.pk for run in listed} == {run.pk for run in runs}


def test_the_seeds_are_said_in_words_and_one_run_says_nothing_of_them(sample, anna):
    page = anna.get("/w/home/results/table/").content.decode()
    assert "seeds</span>" not in page
    seeds(sample, 2, 3, 7)
    page = anna.get("/w/home/results/table/").content.decode()
    assert "mean and standard deviation of </span>3 seeds</span>" in page


def test_the_best_of_a_column_is_the_best_mean(sample):
    sample.run.evaluations.update(accuracy=0.5)
    seeds(sample, 1, 9)
    TrainingRun.objects.get(parser="seq2seq", seed=1).evaluations.update(accuracy=0.6)
    (table,) = tables(sample)
    assert [row.cells[0].is_best for row in table.rows] == [True, False]


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
    asked = requesting.request_seeds(
        sample.world, sample.split, "seq2seq", seeds=(3, 4), send=False
    )
    TrainingRun.objects.filter(pk=asked[0][0].pk).update(status="running", progress=0.5)
    cell = seq2seq_cell(sample)
    assert (cell.status, cell.progress_percent, cell.percent) == ("running", 25.0, None)
    assert anna.get(cell.url).context["listing"].total == 2
    scored_run(sample.world, sample.split, "seq2seq", seed=5)
    assert "2 more on the way" in seq2seq_cell(sample).note


def test_a_run_at_work_shows_its_progress(sample):
    run, _ = requesting.request(sample.world, sample.split, "seq2seq", send=False)
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
    requesting.request(sample.world, sample.split, "seq2seq", train_sources="gen+para", send=False)
    (table,) = tables(sample)
    assert [column.setting for column in table.columns] == [
        ("gen", "gen"),
        ("gen", "para"),
        ("gen+para", "para"),
        ("gen+para", "mixed"),
    ]


def test_columns_are_named_by_criterion_where_that_tells_them_apart(sample):
    other = make_split(sample.world, "other")
    requesting.request(sample.world, other, "knn", send=False)
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
        requesting.request(sample.world, sample.split, "seq2seq", seed=seed, send=False)
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
    assert "No run has been scored on the test part" in page.content.decode()
    assert anna.get("/w/home/results/", {"part": "train"}).context["part"] == "validation"


def test_an_empty_page_says_what_would_be_there(world, anna, adam):
    assert "admins start runs" in anna.get("/w/home/results/").content.decode()
    assert "Start a run" in adam.get("/w/home/results/").content.decode()


def test_the_download_holds_one_line_a_scored_cell(sample, anna):
    answer = anna.get("/w/home/results.csv")
    (row,) = csv.DictReader(io.StringIO(answer.content.decode()))
    assert answer["Content-Disposition"] == 'attachment; filename="home-results.csv"'
    assert (row["parser"], row["train_sources"], row["test_source"]) == ("knn", "gen", "gen")
    assert (row["accuracy"], row["part"], row["split"]) == ("0.25", "validation", "home-split")


def test_the_download_holds_mean_spread_and_number_of_seeds(sample, anna):
    newest = seeds(sample, 2, 6)[-1]
    answer = anna.get("/w/home/results.csv")
    one, several = csv.DictReader(io.StringIO(answer.content.decode()))
    assert (one["mean"], one["spread"], one["n_seeds"]) == ("0.25", "", "1")
    shares = [right / int(several["count"]) for right in (2, 6)]
    assert (several["run_id"], several["n_seeds"]) == (str(newest.pk), "2")
    assert float(several["accuracy"]) == pytest.approx(shares[1])
    assert float(several["mean"]) == pytest.approx(mean(shares))
    assert float(several["spread"]) == pytest.approx(stdev(shares))


def test_no_cell_of_the_download_is_taken_for_a_formula(sample, anna):
    Split.objects.update(name="-1-1")
    assert "'-1-1" in anna.get("/w/home/results.csv").content.decode()


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


def test_a_run_on_a_share_of_the_pairs_is_in_no_table(sample):
    TrainingRun.objects.update(train_share=0.25)
    assert tables(sample) == []


def equivalents(sample, share=0.5):
    sample.run.evaluations.update(equivalent=share)


def test_equivalence_has_its_own_figure_interval_and_best(sample):
    equivalents(sample)
    scored_run(sample.world, sample.split, "seq2seq", right=4)
    both = (Measure.EXACT, Measure.EQUIVALENT)
    (table,) = accuracy_tables(sample.world, "validation", [sample.split], both)
    exact, equivalent = table.rows[0].cells[0].figures
    assert (exact.percent, equivalent.percent) == (25.0, 50.0)
    assert (exact.is_best, equivalent.is_best) == (False, True)
    assert equivalent.low == pytest.approx(25.378, abs=0.01)  # Wilson's interval of 6 of 12
    assert equivalent.high == pytest.approx(74.622, abs=0.01)
    assert "6 of 12 equivalent" in equivalent.note


@pytest.mark.parametrize(
    ("measure", "shown"),
    [("exact", "25.0"), ("equivalent", "50.0"), ("both", "25.0"), ("well_formed", "100.0")],
)
def test_a_switch_says_what_counts_as_right(measure, shown, sample, anna):
    equivalents(sample)
    page = anna.get("/w/home/results/", {"measure": measure}).content.decode()
    assert f"<b>{shown}</b>" in page
    assert ("<b>50.0</b>" in page) == (measure in ("equivalent", "both"))


def test_what_is_misspelled_is_the_default(sample, anna):
    page = anna.get("/w/home/results/", {"measure": "best", "published": "perhaps"})
    assert (page.context["choices"].measure, page.context["choices"].published) == ("exact", False)


@pytest.fixture
def published(sample):
    """The split of the sample as if it were the published one, and the paper's figure of its cell."""
    Split.objects.filter(pk=sample.split.pk).update(seed=None)
    for (source, part), count in SIZES["command"].items():
        there = sample.split.examples.filter(source=source, part=part).count()
        Example.objects.bulk_create(
            Example(
                split=sample.split,
                part=part,
                source=source,
                position=1000 + number,
                utterance="u",
                logical_form="f",
            )
            for number in range(count - there)
        )
    return published_accuracy("knn", ("gen", "gen"), "command")


def test_published_figures_are_shown_on_request(sample, anna, published):
    assert published == 63.0
    page = anna.get("/w/home/results/").content.decode()
    assert "published </span>63.0" not in page and "beside published" in page
    page = anna.get("/w/home/results/", {"published": "yes"}).content.decode()
    assert "published </span>63.0" in page and "Walker, Peng and Cakmak (2019)" in page
    page = anna.get("/w/home/results/", {"published": "yes", "measure": "equivalent"})
    assert "published </span>" not in page.content.decode()


SHOWN = re.compile(r"<b>([0-9.]+)</b>")


@pytest.mark.parametrize("measure", ["exact", "equivalent", "both", "well_formed"])
@pytest.mark.parametrize("beside", ["yes", ""])
def test_every_download_holds_what_the_page_shows(measure, beside, sample, anna, published):
    equivalents(sample, 5 / 12)
    seeds(sample, 2, 6)
    chosen = {"measure": measure, "published": beside, "part": "validation"}
    page = anna.get("/w/home/results/", chosen).content.decode()
    percents = SHOWN.findall(page)
    assert len(percents) == (4 if measure == "both" else 2)
    lines = list(
        csv.DictReader(io.StringIO(anna.get("/w/home/results.csv", chosen).content.decode()))
    )
    assert [f"{float(line['percent']):.1f}" for line in lines] == percents
    answer = anna.get("/w/home/results.json", chosen)
    figures = answer.json()["figures"]
    assert [f"{figure['percent']:.1f}" for figure in figures] == percents
    latex = anna.get("/w/home/results.tex", chosen).content.decode()
    cells = re.findall(r"& (?:\\textbf\{)?([0-9.]+)\}? \{\\scriptsize", latex)
    assert cells == percents
    assert f"±{float(lines[-1]['plus_minus']):.1f}" in page
    assert rf"$\pm$ {figures[-1]['plus_minus']:.1f}" in latex
    is_beside = bool(beside) and measure in ("exact", "both")
    assert {line["published"] for line in lines} >= ({"63.0"} if is_beside else {""})
    assert ("(63.0)" in latex) == is_beside == any(each["published"] == 63.0 for each in figures)


def test_the_downloads_are_offered_with_the_choices_of_the_page(sample, anna):
    page = anna.get("/w/home/results/", {"measure": "both", "part": "test"}).content.decode()
    for ending in ("csv", "tex", "json"):
        query = "part=test&amp;split=home-split&amp;measure=both"
        assert f'href="/w/home/results.{ending}?{query}"' in page


def test_the_latex_has_as_many_cells_in_every_line_and_closes_what_it_opens(sample, anna):
    scored_run(sample.world, sample.split, "seq2seq")
    both = {"measure": "both"}
    latex = anna.get("/w/home/results.tex", both).content.decode()
    (columns,) = re.findall(r"\\begin\{tabular\}\{l(r+)\}", latex)
    for line in latex.splitlines():
        if line.endswith(r"\\"):
            spanned = sum(int(width) - 1 for width in re.findall(r"multicolumn\{(\d+)\}", line))
            assert line.replace(r"\&", "").count("&") + spanned == len(columns)
    assert latex.count("{") == latex.count("}")
    for name in ("table", "tabular"):
        assert latex.count(rf"\begin{{{name}}}") == latex.count(rf"\end{{{name}}}") == 1


def test_what_people_named_is_escaped_in_latex(sample, anna):
    Split.objects.filter(pk=sample.split.pk).update(name="a_b")
    make_split(sample.world, "other")
    requesting.request(sample.world, Split.objects.get(name="other"), "knn", send=False)
    latex = anna.get("/w/home/results.tex").content.decode()
    assert r"a\_b" in latex and "a_b" not in latex.replace(r"a\_b", "")
    assert escape("50 % of {a} & $b^2$ ~ \\x_1 #<>\n") == (
        r"50 \% of \{a\} \& \$b\textasciicircum{}2\$ \textasciitilde{} \textbackslash{}x\_1 "
        r"\#\textless{}\textgreater{} "
    )


@pytest.mark.skipif(not which("pdflatex"), reason="there is no LaTeX")
def test_the_latex_compiles(sample, anna, tmp_path):
    seeds(sample, 2, 6)
    tables_of_all = anna.get("/w/home/results.tex", {"measure": "both"}).content.decode()
    odd = escape('a_b % & # $ ~ ^ \\ {x} <y> "q" |')
    preamble = r"\documentclass{article}\usepackage{booktabs}\begin{document}"
    text = "\n".join([preamble, tables_of_all, odd, r"\end{document}"])
    (tmp_path / "results.tex").write_text(text, encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "results.tex"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    assert (tmp_path / "results.pdf").stat().st_size > 0


def test_a_column_leads_to_its_learning_curves(sample, anna):
    page = anna.get("/w/home/results/").content.decode()
    query = "split=home-split&amp;setting=gen-gen&amp;protocol=strict&amp;part=validation"
    assert f'href="/w/home/results/curves/?{query}"' in page
