"""A model that may have read the corpus bears its mark, with a footnote, wherever its name stands beside figures."""

from __future__ import annotations

import pytest

from parser_service.models import TrainingRun
from parser_service.results.table_parts import MARK, MAY_KNOW_CORPORA
from parser_service.reviews.run_report import run_report
from parser_service.runs.promoting import promote
from tests.sample_world import scored_run

BEHIND_A_NAME = f">{MARK}</abbr></sup>"
FOOTNOTE = f'<p class="quiet small">{MARK} {MAY_KNOW_CORPORA}</p>'
PAGES = (
    *("", "runs/", "runs/new/?parser=knn", "results/", "promotion/"),
    *("results/curves/table/", "results/curves/", "compare/"),
)


@pytest.fixture
def model(sample) -> TrainingRun:
    """A run of a language model, the best of its world."""
    run = scored_run(sample.world, sample.split, "seq2seq", right=9)
    TrainingRun.objects.filter(pk=run.pk).update(parser="llm", config={}, train_pairs=40)
    run.refresh_from_db()
    return run


def text_of(client, path: str) -> str:
    answer = client.get(f"/w/home/{path}", follow=True)
    assert answer.status_code == 200
    body = answer.streaming_content if answer.streaming else [answer.content]
    return b"".join(body).decode()


@pytest.mark.parametrize("path", PAGES)
def test_pages_mark_it_and_say_why(path, model, adam):
    page = text_of(adam, path)
    assert BEHIND_A_NAME in page
    assert page.count(FOOTNOTE) == 1


@pytest.mark.parametrize("path", PAGES)
def test_pages_without_it_have_neither(path, sample, adam):
    assert MARK not in text_of(adam, path)


def test_its_own_page_and_report_bear_the_mark(model, sample, anna):
    page = text_of(anna, f"runs/{model.pk}/")
    assert f">Language model {MARK}</span></h1>" in page and FOOTNOTE in page
    report = "".join(run_report(model, "validation"))
    assert f"<h1>Language model {MARK}, run {model.pk}</h1>" in report and FOOTNOTE in report
    assert MARK not in text_of(anna, f"runs/{sample.run.pk}/")
    assert MARK not in "".join(run_report(sample.run, "validation"))


@pytest.mark.parametrize("name", ["predictions", "defaults", "sensitivity", "probes"])
def test_pages_of_its_answers_bear_the_mark_beside_its_name(name, model, sample, anna):
    text = text_of(anna, f"runs/{model.pk}/{name}/")
    assert f">Language model {MARK}, run {model.pk}</span></h1>" in text and FOOTNOTE in text
    assert MARK not in text_of(anna, f"runs/{sample.run.pk}/{name}/")


def test_the_chart_of_the_learning_curves_names_it_with_the_mark(model, sample, anna):
    data = anna.get("/w/home/results/curves/data/").json()
    assert [one["name"] for one in data["series"]] == [
        "Nearest neighbour",
        f"Language model {MARK}",
    ]


def test_a_comparison_and_its_report_mark_it(model, sample, anna):
    chosen = f"?part=validation&run={model.pk}&run={sample.run.pk}"
    for path in (f"compare/{chosen}", f"compare/report.html{chosen}"):
        page = text_of(anna, path)
        assert page.count(BEHIND_A_NAME) > 1 and page.count(FOOTNOTE) == 1


def test_evidence_for_its_promotion_is_marked(model, sample, adam):
    promote(model, None)
    page = text_of(adam, "promotion/")
    assert BEHIND_A_NAME in page and page.count(FOOTNOTE) == 1
