"""By form every page shows unseen forms, known forms and their harmonic mean together."""

from __future__ import annotations

import re

import pytest

from gpsr_site.overview.best_runs import best_runs
from parser_service.reviews.run_report import run_report
from parser_service.runs.promoting import promote
from parser_service.runs.score_evidence import compare_scores
from tests.parser_service.web.results.test_result_pages import by_form
from tests.sample_world import scored_run

TOGETHER = "unseen&nbsp;50.0 · known&nbsp;75.0"


@pytest.fixture
def run(sample):
    by_form(sample)
    sample.run.refresh_from_db()
    return sample.run


def text_of(client, path: str) -> str:
    answer = client.get(f"/w/home/{path}")
    assert answer.status_code == 200
    return " ".join(answer.content.decode().split())


@pytest.mark.parametrize("path", ["runs/", "runs/new/?parser=knn", "compare/", "promotion/", ""])
def test_pages_show_the_harmonic_mean_with_what_it_is_of(path, run, adam):
    page = text_of(adam, path)
    assert "60.0" in page and TOGETHER in page
    assert not re.search(r"known(?: |&nbsp;)75\.0(?: |<[^>]*>)*[,.;]", page)


@pytest.mark.parametrize("path", ["runs/", "runs/new/?parser=knn", "compare/", "promotion/", ""])
def test_pages_say_where_known_forms_were_not_held_out(path, run, adam):
    run.evaluations.filter(part="known").delete()
    page = text_of(adam, path)
    assert "unseen forms alone" in page and "unseen&nbsp;50.0" not in page


def test_other_splits_have_one_figure(sample, adam):
    page = text_of(adam, "runs/")
    assert "25.0" in page and "unseen" not in page.split("<tbody>")[1]


def test_the_page_of_a_run_shows_all_three(run, anna):
    page = text_of(anna, f"runs/{run.pk}/")
    (score,) = anna.get(f"/w/home/runs/{run.pk}/").context["by_form"]
    assert (score.percent, [each.percent for each in score.parts]) == (pytest.approx(60), [50, 75])
    assert score.low < 60 < score.high
    for text in (
        "Harmonic mean, %",
        "<b>60.0</b>",
        ">50.0 <",
        ">75.0 <",
        "validation, unseen forms",
    ):
        assert text in page
    run.evaluations.filter(part="known").delete()
    assert "train again for the accuracy on known forms" in text_of(anna, f"runs/{run.pk}/")


def test_the_report_of_a_run_shows_all_three(run):
    report = " ".join("".join(run_report(run, "validation")).split())
    assert "<b>60.0</b>" in report and "Unseen forms, %" in report
    assert "validation, gen, harmonic mean" in report  # in the chart
    assert "known forms, gen" in report and "validation, unseen forms, gen" in report


def test_compared_runs_stand_beside_their_harmonic_means(run, sample, anna):
    other = scored_run(sample.world, sample.split, seed=1)
    page = text_of(anna, f"compare/?part=validation&run={run.pk}&run={other.pk}")
    after = page.split("What is compared here has unseen forms")[1]
    assert TOGETHER in after and "unseen forms alone" in after


def test_a_run_is_promoted_by_its_harmonic_mean(run, sample, anna):
    other = scored_run(sample.world, sample.split, seed=1)
    (row,) = compare_scores(run, other)
    assert row.change is None  # one on unseen forms alone
    (row,) = compare_scores(run, run)
    assert (row.score.percent, row.change) == (pytest.approx(60), 0)
    promote(run, None)
    assert TOGETHER in text_of(anna, "promotion/")


def test_the_best_run_knows_its_forms_still(run, sample):
    scored_run(sample.world, sample.split, right=11, seed=1)  # on unseen forms alone
    (best,) = best_runs(sample.world).runs
    assert best.score.run == run


def test_rest_has_all_three(run, anna):
    rows = anna.get(f"/api/v1/worlds/home/evaluations/?run={run.pk}").json()["results"]
    by_part = {row["part"]: row for row in rows}
    assert by_part["validation"]["accuracy_known"] == 0.75
    assert by_part["validation"]["harmonic_mean"] == pytest.approx(0.6)
    assert by_part["known"]["harmonic_mean"] is None
    one = anna.get(f"/api/v1/worlds/home/evaluations/{by_part['validation']['id']}/").json()
    assert one["harmonic_mean"] == pytest.approx(0.6)
