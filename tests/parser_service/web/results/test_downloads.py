"""The tables as CSV, LaTeX and JSON."""

from __future__ import annotations

import csv
import io
import re
import subprocess
from shutil import which
from statistics import mean, stdev

import pytest
from django.urls import reverse

from annotations.models import Split
from parser_service.models import TrainingRun
from parser_service.parsers.registry import config_values, make_config
from parser_service.results.export import COLUMNS
from parser_service.results.latex import escape
from parser_service.results.table_parts import MAY_KNOW_CORPORA
from parser_service.runs import run_requests
from tests.parser_service.made_up import make_split
from tests.parser_service.web.results.conftest import equivalents, seeds
from tests.sample_world import scored_run

SHOWN = re.compile(r"<b>([0-9.]+)</b>")


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


@pytest.mark.parametrize("measure", ["exact", "equivalent", "same_plan", "all", "well_formed"])
@pytest.mark.parametrize("beside", ["yes", ""])
def test_every_download_holds_what_the_page_shows(measure, beside, sample, anna, published):
    equivalents(sample, 5 / 12)
    seeds(sample, 2, 6)
    chosen = {"measure": measure, "published": beside, "part": "validation"}
    page = anna.get("/w/home/results/", chosen).content.decode()
    percents = SHOWN.findall(page)
    assert len(percents) == (6 if measure == "all" else 2)
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
    is_beside = bool(beside) and measure in ("exact", "all")
    assert {line["published"] for line in lines} >= ({"63.0"} if is_beside else {""})
    assert ("(63.0)" in latex) == is_beside == any(each["published"] == 63.0 for each in figures)


def test_a_figure_that_is_not_known_is_a_line_without_numbers(sample, anna):
    sample.run.evaluations.update(same_plan=None)
    seeds(sample, 2)
    chosen = {"measure": "same_plan", "part": "validation"}
    unknown, known = anna.get("/w/home/results.json", chosen).json()["figures"]
    assert (unknown["measure"], unknown["percent"], unknown["same_plan"]) == (
        "same_plan",
        None,
        None,
    )
    assert unknown["accuracy"] == 0.25
    assert known["percent"] == pytest.approx(100 * known["same_plan"])
    lines = csv.DictReader(
        io.StringIO(anna.get("/w/home/results.csv", chosen).content.decode(), newline="")
    )
    assert [line["percent"] == "" for line in lines] == [True, False]
    assert "& -- " in anna.get("/w/home/results.tex", chosen).content.decode()
    assert SHOWN.findall(anna.get("/w/home/results/", chosen).content.decode()) == ["16.7"]


@pytest.mark.parametrize(
    "address",
    ["/w/home/results.{}?measure=all", "/api/v1/worlds/home/results/?measure=all&format={}"],
)
def test_pandas_reads_tables_as_they_are(address, sample, anna):
    import pandas

    seeds(sample, 2, 6)
    sample.run.evaluations.update(same_plan=None)
    figures = anna.get(address.format("json")).json()["figures"]
    parquet, csv_ = (anna.get(address.format(as_)) for as_ in ("parquet", "csv"))
    table = pandas.read_parquet(io.BytesIO(parquet.content))
    cells = table.astype(object)
    assert cells.where(cells.notna(), None).to_dict("records") == figures
    assert list(table) == list(COLUMNS) and len(table) == 6
    numbers = ["run_id", "n_seeds", "accuracy", "percent", "spread", "published"]
    assert [table[name].dtype.kind for name in numbers] == [*"iiffff"]
    plain = pandas.read_csv(io.BytesIO(csv_.content), keep_default_na=False)
    assert plain.astype(str).equals(cells.astype(object).where(cells.notna(), "").astype(str))
    assert (parquet["Content-Type"], csv_["Content-Type"]) == (
        "application/vnd.apache.parquet",
        "text/csv; charset=utf-8",
    )


def test_a_format_that_there_is_not_is_refused(sample, anna):
    assert anna.get("/w/home/results.xlsx").status_code == 404
    refused = anna.get("/api/v1/worlds/home/results/?format=xlsx")
    assert refused.status_code == 400
    assert refused.json()["problems"][0]["field"] == "format"
    accepted = anna.get("/api/v1/worlds/home/results/?format=csv", headers={"accept": "text/csv"})
    assert accepted.status_code == 200


def test_the_downloads_are_offered_with_the_choices_of_the_page(sample, anna):
    page = anna.get("/w/home/results/", {"measure": "all", "part": "test"}).content.decode()
    for ending in ("csv", "parquet", "tex", "json"):
        query = "part=test&amp;split=home-split&amp;measure=all"
        assert f'href="/w/home/results.{ending}?{query}"' in page


def test_the_latex_has_as_many_cells_in_every_line_and_closes_what_it_opens(sample, anna):
    scored_run(sample.world, sample.split, "seq2seq")
    every = {"measure": "all"}
    latex = anna.get("/w/home/results.tex", every).content.decode()
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
    run_requests.request(sample.world, Split.objects.get(name="other"), "knn", send=False)
    latex = anna.get("/w/home/results.tex").content.decode()
    assert r"a\_b" in latex and "a_b" not in latex.replace(r"a\_b", "")
    assert escape("50 % of {a} & $b^2$ ~ \\x_1 #<>\n") == (
        r"50 \% of \{a\} \& \$b\textasciicircum{}2\$ \textasciitilde{} \textbackslash{}x\_1 "
        r"\#\textless{}\textgreater{} "
    )


@pytest.mark.skipif(not which("pdflatex"), reason="there is no LaTeX")
def test_the_latex_compiles(sample, anna, tmp_path):
    seeds(sample, 2, 6)
    tables_of_all = anna.get("/w/home/results.tex", {"measure": "all"}).content.decode()
    odd = escape('a_b % & # $ ~ ^ \\ {x} <y> "q" |')
    preamble = r"\documentclass{article}\usepackage{booktabs}\begin{document}"
    text = "\n".join([preamble, tables_of_all, odd, r"\end{document}"])
    (tmp_path / "results.tex").write_text(text, encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "results.tex"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    assert (tmp_path / "results.pdf").stat().st_size > 0


def test_a_model_that_may_have_read_the_corpus_is_marked_everywhere(sample, anna):
    unmarked = anna.get("/w/home/results/").content.decode()
    assert "†" not in unmarked and "dagger" not in anna.get("/w/home/results.tex").content.decode()
    run = scored_run(sample.world, sample.split, "seq2seq", 2)
    config = config_values(make_config("llm", {"model": "tiny"}))
    TrainingRun.objects.filter(pk=run.pk).update(
        parser="llm", config=config, answered_by="tiny-2026-07"
    )
    page = anna.get("/w/home/results/").content.decode()
    assert page.count(">†</abbr></sup>") == 1 and f"† {MAY_KNOW_CORPORA}" in page
    assert " tiny-2026-07" in page and "model tiny" in page
    for name in ("predictions", "defaults", "sensitivity", "probes"):
        of_run = anna.get(reverse(name, args=["home", run.pk])).content.decode()
        assert f"† {MAY_KNOW_CORPORA}" in of_run
    lines = csv.DictReader(io.StringIO(anna.get("/w/home/results.csv").content.decode()))
    assert [(each["parser"], each["answered_by"], each["may_know_corpora"]) for each in lines] == [
        ("knn", "", "False"),
        ("llm", "tiny-2026-07", "True"),
    ]
    figures = anna.get("/w/home/results.json").json()["figures"]
    assert [each["may_know_corpora"] for each in figures] == [False, True]
    latex = anna.get("/w/home/results.tex").content.decode()
    assert r"Language model (model tiny)$^\dagger$ &" in latex
    assert rf"$^\dagger$ {MAY_KNOW_CORPORA}" in latex
