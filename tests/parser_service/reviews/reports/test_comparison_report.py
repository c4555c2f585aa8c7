"""The report of a comparison: valid, loads nothing, with the figures of the compare page."""

from __future__ import annotations

import pytest

from parser_service.models import Prediction, TrainingRun
from parser_service.parsers.registry import title_of
from tests.notices import levels
from tests.parser_service.reviews.reports.reading import addresses, parse, table, texts
from tests.parser_service.reviews.reports.validating import validate
from tests.sample_world import scored_run


@pytest.fixture
def runs(sample) -> list[TrainingRun]:
    """Two runs, of which the second is right on twice as many examples."""
    return [sample.run, scored_run(sample.world, sample.split, right=6, seed=1)]


@pytest.fixture
def ask(runs, anna):
    """Ask for the page or the report of these runs."""

    def ask(path: str = "", **chosen: str):
        keys = [run.pk for run in runs]
        return anna.get(f"/w/home/compare/{path}", {"run": keys, "part": "validation", **chosen})

    return ask


def html_of(answer) -> str:
    return b"".join(answer.streaming_content).decode()


def test_the_file_is_valid_and_loads_nothing(ask, tmp_path):
    html = html_of(ask("report.html"))
    assert validate(html, tmp_path) == []
    document = parse(html)
    assert addresses(document) == set()
    assert not document.query("script, link, img, iframe, object, embed")


def test_the_figures_are_those_of_the_page(ask, runs):
    page = ask().context
    document = parse(html_of(ask("report.html")))
    shown = table(document, "differences")
    for row, (letter, run, cell) in zip(shown, page["accuracies"], strict=True):
        assert row[0] == f"{letter}, {title_of(run.parser)}, run {run.pk}"
        assert row[1:3] == [str(cell.correct), str(cell.count)]
        assert row[3] == f"{cell.percent:.1f} {cell.low:.1f}–{cell.high:.1f}"
    (pair,) = page["pairs"]
    (row,) = table(document, "differences", 2)
    assert row[1:4] == [
        str(pair.comparison.wins),
        str(pair.comparison.losses),
        str(pair.comparison.ties),
    ]
    assert row[-1] == pair.meaning
    matrix = [[cells[0].count, cells[1].count] for _, cells in page["matrix"]]
    assert [row[1:] for row in table(document, "differences", 1)] == [
        ["–" if count is None else str(count) for count in counts] for counts in matrix
    ]


def test_slices_are_those_of_the_page(ask):
    page = ask().context
    document = parse(html_of(ask("report.html")))
    for number, breakdown in enumerate(page["breakdowns"]):
        shown = table(document, "slices", number)
        assert [row[0] for row in shown] == [row.title for row in breakdown.rows]
        for row, expected in zip(shown, breakdown.rows, strict=True):
            figures = [
                f"{cell.percent:.1f} {cell.low:.1f}–{cell.high:.1f}" for cell in expected.cells
            ]
            assert row[1:] == [str(expected.count), *figures]


def test_the_examples_on_which_the_runs_differ_are_listed(ask, runs):
    document = parse(html_of(ask("report.html")))
    rows = table(document, "answers")
    first, second = (
        {row.example_id for row in run.predictions.filter(is_exact_match=True)} for run in runs
    )
    assert len(rows) == len(first ^ second) == 3
    assert all("right" in row[2:] for row in rows)


def test_filters_choose_the_examples_and_are_told(ask):
    document = parse(html_of(ask("report.html", source="generated")))
    assert "Source Generated" in texts(document, "#runs dl")[-1]
    assert table(document, "differences")[0][2] == "6"


def test_a_slice_without_examples_and_a_single_run_have_no_report(ask, runs, anna):
    answer = ask("report.html", q="nobody says this")
    assert answer.status_code == 302 and "/compare/?" in answer.url
    alone = anna.get("/w/home/compare/report.html", {"run": runs[0].pk}, follow=True)
    assert set(levels(alone)) == {"info"}


def test_the_page_leads_to_it_with_its_own_address(ask):
    page = ask(source="generated").content.decode()
    assert "compare/report.html?" in page and "source=generated" in page


def test_what_somebody_wrote_is_text(ask, runs):
    Prediction.objects.filter(run=runs[0], is_exact_match=False).update(
        logical_form="<script>alert(1)</script>\x0b", is_well_formed=False
    )
    html = html_of(ask("report.html"))
    assert "<script" not in html and "&lt;script&gt;" in html and "\x0b" not in html
