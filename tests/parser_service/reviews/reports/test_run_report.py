"""The report of a run: a valid file that loads nothing, whose figures are those of the pages."""

from __future__ import annotations

import re

import numpy as np
import pytest

from parser_service.analysis.encoded_labels import encode
from parser_service.analysis.outcomes import encode_clusters
from parser_service.analysis.slicing import accuracy_of_labels
from parser_service.models import ErrorCategory, Prediction, Review, RunAnalysis
from parser_service.results.accuracy_cells import PLANS_NOT_COMPARED
from parser_service.results.measures import Measure, interval_of, share_of
from parser_service.reviews import run_report_rows
from parser_service.reviews.run_report import part_of
from parser_service.runs.split_pairs import cluster_of
from tests.notices import levels
from tests.parser_service.reviews.reports.conftest import EVIL
from tests.parser_service.reviews.reports.reading import addresses, parse, table, texts
from tests.parser_service.reviews.reports.validating import validate

EDIT = {
    "kind": "article",
    "edits": 10,
    "flip_rate": 0.2,
    "flip_interval": [0.1, 0.3],
    "distance": 0.1,
}
FINDINGS = {
    "attractors": {
        "para": [
            {
                **{"form": '( go " <room> " )', "predicted": 7, "missed": 1, "annotated": 2},
                **{"q_value": 0.0004, "dispersion": 0.9, "own_dispersion": None},
                **{"is_attractor": True, "inputs": ["bring & tea"]},
            }
        ],
        "gen": [],
    },
    "risk_coverage": {
        "para": {
            **{"count": 4, "correct": 3, "unanswered": 1, "area": 0.2, "best_area": 0.1},
            **{"bounds": [None, 0.9, 0.1], "answered": [0, 2, 4], "wrong": [0, 0, 1]},
            **{"calibration_error": 0.123, "brier_score": 0.045},
        }
    },
    "sensitivity": [
        {**EDIT, "label_distance": 0, "consistency": 0.5, "consistency_interval": [0.4, 0.6]}
    ],
    "deciding_words": {
        **{"trials": 8, "changes": 4, "single": "bring"},
        "words": [{"word": "bring", "trials": 4, "changes": 4, "rate": 1.0}],
    },
    "pairs": {"pairs": 5, "flips": 1, "rows": []},
    "slots": {"rows": [["bring", 2, "location", "room", 3]], "examples": {}},
}


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
    assert row[:3] == ["validation", "generated", f"{100 * score.accuracy:.1f}"]
    assert row[4:6] == [str(score.correct), str(score.count)]
    assert f"{100 * score.accuracy:.1f}" in page.content.decode()
    for measure, told in ((Measure.EQUIVALENT, row[6]), (Measure.SAME_PLAN, row[7])):
        low, high = (f"{100 * end:.1f}" for end in interval_of(score, measure))
        assert told == f"{100 * share_of(score, measure):.1f} {low}–{high}"
        assert f"{low}–{high}" in page.content.decode()


def test_what_was_not_compared_has_a_dash(report, run, anna):
    run.evaluations.update(same_plan=None)
    (row,) = table(parse(report()), "accuracy")
    assert row[7] == "–"
    assert PLANS_NOT_COMPARED in anna.get(f"/w/home/runs/{run.pk}/").content.decode()


def test_slices_are_those_of_the_analysis(report, run):
    rows = run.predictions.best().filter(example__part="validation").select_related("example")
    correct = np.array([[row.is_exact_match for row in rows]])
    clusters = encode_clusters([cluster_of(row.example, run.split.criterion) for row in rows])
    expected = accuracy_of_labels(correct, encode([row.example.source for row in rows]), clusters)
    document = parse(report())
    titles = texts(document, "#slices h3")
    shown = {row[0]: row[1:] for row in table(document, "slices", titles.index("Source"))}
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
    tables = document.query("#slices table")
    assert tables
    for number in range(len(tables)):
        assert sum(int(row[1]) for row in table(document, "slices", number)) == 12


def test_reviews_are_counted_with_examples(report, run, reviewer):
    category = ErrorCategory.objects.create(
        world=run.world, code="wrong_place", name="Wrong <place>", position=0
    )
    wrong = run.predictions.filter(is_exact_match=False)[:5]
    for row in wrong:
        Review.objects.create(
            run=run,
            example=row.example,
            category=category,
            is_proposed=True,
            answer=row.logical_form,
        )
    Review.objects.create(
        run=run, example=wrong[0].example, category=category, reviewer=reviewer, note="<b>no</b>"
    )
    document = parse(report())
    assert table(document, "categories") == [["Wrong <place>", "5", "1"]]
    assert len(table(document, "categories", 1)) == 3
    assert "<b>no</b>" in texts(document, "#categories")[0]


def test_what_a_worker_found_out_is_shown(report, run, tmp_path):
    RunAnalysis.objects.create(run=run, part="validation", version=1, findings=FINDINGS)
    html = report()
    assert validate(html, tmp_path) == []
    document = parse(html)
    assert table(document, "attractors")[0][:4] == ['( go " <room> " )', "bring & tea", "7", "1"]
    assert table(document, "refusing") == [
        ["para", "4", "3", "1", "0.200", "0.100", "0.123", "0.045"]
    ]
    assert len(document.query("#refusing polyline")) == 1
    assert table(document, "sensitivity")[0][:3] == ["article", "10", "20.0 10.0–30.0"]
    assert "bring" in texts(document, "#sensitivity p strong")
    assert table(document, "confusions", 1) == [["bring", "2", "location", "room", "3"]]


def test_without_findings_their_sections_are_left_out(report):
    anchors = [each.attrs["id"] for each in parse(report()).query("main > section")]
    assert not {"attractors", "refusing", "sensitivity", "categories"} & set(anchors)


def test_wrong_answers_are_listed_with_their_differences(report, run):
    document = parse(report())
    rows = table(document, "wrong")
    assert len(rows) == run.predictions.filter(is_exact_match=False).count() == 9
    assert {row[3] for row in rows} == {"malformed", "no answer", "wrong"}
    assert document.query("#wrong ins, #wrong del, #wrong mark")
    assert "All 9 of them" in texts(document, "#wrong > p")[0]


def test_the_number_of_wrong_answers_is_bounded_and_told(report, monkeypatch):
    monkeypatch.setattr("parser_service.reviews.run_report.MOST_WRONG", 4)
    monkeypatch.setattr(run_report_rows.wrong_answers, "__defaults__", (4,))
    document = parse(report())
    assert len(table(document, "wrong")) == 4
    assert "The first 4 of 9 wrong answers" in texts(document, "#wrong > p")[0]


def test_a_run_that_is_always_right_has_a_report(report, run):
    for row in run.predictions.select_related("example"):
        Prediction.objects.filter(pk=row.pk).update(
            logical_form=row.example.logical_form, is_exact_match=True, is_well_formed=True
        )
    document = parse(report())
    assert texts(document, "#wrong > p")[0] and not texts(document, "#wrong tbody tr")
    assert texts(document, "#confusions")[0] and not texts(document, "#confusions table")


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
    assert levels(answer) == ["info"]
    assert "report.html" not in answer.content.decode()
