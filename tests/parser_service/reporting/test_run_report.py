"""The report of a run: a valid file that loads nothing, whose figures are those of the pages."""

from __future__ import annotations

import re

import numpy as np
import pytest

from parser_service.analysis.slicing import accuracy_by
from parser_service.models import Prediction
from parser_service.reporting import wrong_answers
from parser_service.reporting.run_report import part_of
from tests.parser_service.reporting.conftest import EVIL
from tests.parser_service.reporting.reading import addresses, parse, table, texts
from tests.parser_service.reporting.validating import validate


def test_the_file_is_valid(report, tmp_path):
    assert validate(report(), tmp_path) == []


def test_the_validator_finds_what_is_wrong(tmp_path):
    assert validate("<p><div id=a></div><div id=a></div></p>", tmp_path)


def test_the_file_loads_nothing(report):
    html = report()
    document = parse(html)
    assert addresses(document) == set()
    assert not document.query("script, link, img, iframe, object, embed, base, form")
    assert "@import" not in html and "url(" not in html
    (policy,) = document.query('meta[http-equiv="Content-Security-Policy"]')
    assert policy.attrs["content"] == "default-src 'none'; style-src 'unsafe-inline'"


def test_what_somebody_wrote_is_text(report):
    html = report()
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in html
    assert "<script" not in html and "<img" not in html
    assert not re.search(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\ufffe]", html)
    assert EVIL not in html


def test_every_entry_of_the_contents_leads_to_a_section(report):
    document = parse(report())
    anchors = [each.attrs["href"].removeprefix("#") for each in document.query("nav a")]
    assert anchors == [each.attrs["id"] for each in document.query("main > section")]
    assert len(anchors) == len(set(anchors)) > 4


def test_the_figures_are_those_of_the_page(report, run, anna):
    page = anna.get(f"/w/home/runs/{run.pk}/")
    (score,) = page.context["evaluations"]
    (row,) = table(parse(report()), "accuracy")
    assert row[:3] == ["validation", "gen", f"{100 * score.accuracy:.1f}"]
    assert row[4:6] == [str(score.correct), str(score.count)]
    assert f"{100 * score.accuracy:.1f}" in page.content.decode()


def test_slices_are_those_of_the_analysis(report, run):
    rows = run.predictions.best().filter(example__part="validation").select_related("example")
    correct = np.array([[row.is_exact_match for row in rows]])
    expected = accuracy_by(correct, [row.example.source for row in rows])
    shown = {row[0]: row[1:] for row in table(parse(report()), "slices")}
    assert set(shown) == set(expected.values) == {"generated", "paraphrased"}
    for place, source in enumerate(expected.values):
        low, high = 100 * expected.low[0, place], 100 * expected.high[0, place]
        accuracy = 100 * expected.accuracies[0, place]
        assert shown[source] == [
            str(expected.counts[place]),
            f"{accuracy:.1f} {low:.1f}–{high:.1f}",
        ]


def test_every_kind_of_slice_counts_all_examples(report):
    document = parse(report())
    for number in range(len(document.query("#slices table"))):
        assert sum(int(row[1]) for row in table(document, "slices", number)) == 12


def test_wrong_answers_are_listed_with_their_differences(report, run):
    document = parse(report())
    rows = table(document, "wrong")
    assert len(rows) == run.predictions.filter(is_exact_match=False).count() == 9
    assert {row[3] for row in rows} == {"malformed", "no answer", "wrong"}
    assert document.query("#wrong ins, #wrong del, #wrong mark")
    assert "All 9 of them" in texts(document, "#wrong > p")[0]


def test_the_number_of_wrong_answers_is_bounded_and_told(report, monkeypatch):
    monkeypatch.setattr("parser_service.reporting.run_report.MOST_WRONG", 4)
    monkeypatch.setattr(wrong_answers.wrong_answers, "__defaults__", (4,))
    document = parse(report())
    assert len(table(document, "wrong")) == 4
    assert "The first 4 of 9 wrong answers" in texts(document, "#wrong > p")[0]


def test_a_run_that_is_always_right_has_a_report(report, run):
    for row in run.predictions.select_related("example"):
        Prediction.objects.filter(pk=row.pk).update(
            logical_form=row.example.logical_form, is_exact_match=True, is_well_formed=True
        )
    document = parse(report())
    assert "Every answer is right." in texts(document, "#wrong > p")[0]
    assert "Every answer has the head predicate" in texts(document, "#confusions")[0]


@pytest.mark.parametrize(
    ("asked", "part"), [("", "validation"), ("validation", "validation"), ("test", "validation")]
)
def test_the_part_is_one_that_the_run_was_tested_on(run, asked, part):
    assert part_of(run, asked) == part


def test_it_is_downloaded_as_a_file_in_pieces(run, anna):
    answer = anna.get(f"/w/home/runs/{run.pk}/report.html?part=test")
    assert answer.streaming
    assert answer["Content-Disposition"] == (
        f'attachment; filename="home-run-{run.pk}-validation.html"'
    )
    assert "<!doctype html>" in b"".join(answer.streaming_content).decode()
    assert f"/runs/{run.pk}/report.html" in anna.get(f"/w/home/runs/{run.pk}/").content.decode()


def test_a_run_without_results_has_none(run, anna):
    run.evaluations.all().delete()
    answer = anna.get(f"/w/home/runs/{run.pk}/report.html", follow=True)
    assert "nothing to report" in answer.content.decode()
    assert "report.html" not in answer.content.decode()
