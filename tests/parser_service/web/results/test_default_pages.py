"""The pages of unexpected defaults, sensitivity and probes, of runs that a worker has analysed."""

from __future__ import annotations

import re

import pytest

from parser_service.models import ProbeAnswer, TrainingRun
from parser_service.runs.analysis_requests import analysis_jobs
from tests.notices import levels
from tests.parser_service.reviews.analyses.conftest import analysed, done, home, train_one  # noqa: F401
from tests.parser_service.reviews.analyses.made_parsers import DEFAULT, WORD

PAGES = ("defaults", "sensitivity", "probes")


def page_of(client, run: TrainingRun, name: str, /, **query: object):
    answer = client.get(f"/w/home/runs/{run.pk}/{name}/", query)
    assert answer.status_code == 200
    return answer


def text_of(answer) -> str:
    return re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", answer.content.decode()))


@pytest.mark.parametrize("name", PAGES)
def test_before_the_analysis_the_page_says_what_to_do(name, sample, rene, anna):
    start = f'action="/w/home/runs/{sample.run.pk}/analysis/start/"'
    for browser, may_start in ((rene, True), (anna, False)):
        page = page_of(browser, sample.run, name)
        assert page.context["analysis"].made_at is None
        assert (start in page.content.decode()) is may_start


def test_a_reviewer_starts_and_cancels_the_analysis(sample, rene):
    here = f"/w/home/runs/{sample.run.pk}/defaults/"
    start, cancel = (
        f"/w/home/runs/{sample.run.pk}/analysis/{verb}/" for verb in ("start", "cancel")
    )
    assert rene.post(start, {"next": here}).url == here
    assert rene.post(start).url == f"/w/home/runs/{sample.run.pk}/"
    job = analysis_jobs(sample.run).get()
    assert job.status == "queued"
    assert f'action="{cancel}"' in rene.get(here).content.decode()
    assert rene.post(cancel, {"next": "https://elsewhere.example/"}).url.startswith("/w/home/")
    job.refresh_from_db()
    assert job.status == "cancelled"
    assert rene.post(cancel, {"next": here}).url == here


def test_what_the_world_of_today_proposes_is_made_anew(analysed, rene):  # noqa: F811
    run = analysed("always-one")
    run.world.error_categories.filter(code="unexpected_default").delete()
    asked = list(run.probes.values_list("answer__pk", flat=True))
    start = f'action="/w/home/runs/{run.pk}/analysis/start/"'
    page = page_of(rene, run, "defaults")
    assert page.context["analysis"].is_complete and start in page.content.decode()
    rene.post(f"/w/home/runs/{run.pk}/analysis/start/")
    job = analysis_jobs(run).first()
    assert job.arguments == {"run": run.pk, "again": True}
    assert start not in page_of(rene, run, "defaults").content.decode()
    assert done(job).status == "succeeded"
    assert not run.reviews.proposed().filter(category=None).exists()
    assert run.reviews.proposed().count() == 24
    assert list(run.probes.values_list("answer__pk", flat=True)) == asked


def test_a_run_that_has_not_succeeded_is_not_analysed(sample, rene):
    TrainingRun.objects.filter(pk=sample.run.pk).update(status="failed")
    answer = rene.post(f"/w/home/runs/{sample.run.pk}/analysis/start/", follow=True)
    assert levels(answer) == ["error"]
    assert not analysis_jobs(sample.run).exists()


def test_the_default_of_a_parser_leads_to_its_inputs(analysed, rene):  # noqa: F811
    run = analysed("always-one")
    page = page_of(rene, run, "defaults", part="validation", source="para")
    assert [row["form"] for row in page.context["attractors"]] == [DEFAULT]
    assert page.context["attractors"][0]["is_attractor"]
    link = re.search(r'href="([^"]*answer_form=[^"]*)"', page.content.decode())[1].replace(
        "&amp;", "&"
    )
    listed = rene.get(link).context["listing"]
    assert listed.total == 6
    assert {row.logical_form for row in listed.rows} == {DEFAULT}


def test_what_refusing_costs_is_said_for_the_bound_of_the_url(analysed, rene):  # noqa: F811
    run = analysed("always-one")
    page = page_of(rene, run, "defaults")
    assert page.context["place"] == 0 and page.context["chosen"].sentence in text_of(page)
    page = page_of(rene, run, "defaults", bound="1")
    assert page.context["chosen"].bound == "1"
    for odd in ("nan", "inf", "-inf", "x", "", "1e999", "0"):
        assert page_of(rene, run, "defaults", bound=odd).context["place"] == 0


@pytest.mark.parametrize("odd", ["", "x", "train", "\0", "<script>alert(1)</script>"])
def test_odd_choices_show_the_first_part_and_source(odd, analysed, rene):  # noqa: F811
    page = page_of(rene, analysed("perfect"), "defaults", part=odd, source=odd)
    assert (page.context["part"], page.context["source"]) == ("validation", "para")


def test_the_probes_of_a_kind_are_summarized(analysed, rene):  # noqa: F811
    page = page_of(rene, analysed("always-one"), "defaults")
    rows = {row.kind: row for row in page.context["summaries"]}
    assert rows["empty"].share == rows["unrelated"].share == 1
    assert rows["empty"].commonest == DEFAULT
    rows = {
        row.kind: row for row in page_of(rene, analysed("perfect"), "defaults").context["summaries"]
    }
    assert rows["empty"].share == rows["unrelated"].share == 0


def test_the_word_that_decides_is_named_and_leads_to_its_edits(analysed, rene):  # noqa: F811
    run = analysed("one-word")
    page = page_of(rene, run, "sensitivity")
    assert page.context["words"]["single"] == WORD and f"“{WORD}”" in text_of(page)
    listed = page_of(rene, run, "probes", kind="removal", word=WORD).context["listing"]
    assert listed.total == 2
    assert all(row.before != row.answer.logical_form for row in listed.rows)


def test_a_perfect_parser_hangs_on_no_word_and_has_no_default(analysed, rene):  # noqa: F811
    run = analysed("perfect")
    assert page_of(rene, run, "sensitivity").context["words"]["single"] is None
    assert page_of(rene, run, "defaults").context["attractors"] == []
    assert page_of(rene, run, "probes", outcome="unexpected").context["listing"].total == 0


def test_runs_stand_side_by_side(analysed, rene):  # noqa: F811
    first, other = analysed("perfect"), analysed("always-one")
    page = page_of(rene, first, "sensitivity", run=other.pk)
    assert page.context["others"] == [other]
    assert all(len(each.rows) == 2 for each in page.context["kinds"])
    for odd in ("x", "-1", "9" * 30, "0", first.pk, "²"):
        assert page_of(rene, first, "sensitivity", run=odd).context["others"] == []


def test_the_texts_of_the_paper_stand_on_both_pages(analysed, rene):  # noqa: F811
    run, default = analysed("perfect"), analysed("always-one")
    for name in ("defaults", "sensitivity"):
        page = page_of(rene, run, name)
        assert page.context["paper_runs"] == [run, default]
        texts = page.context["paper_texts"]
        assert [row.text for row in texts][2:4] == ["Do this then that", "Bring an umbrella to me"]
        assert {row.answers[1][1].logical_form for row in texts} == {DEFAULT}
        assert {answer.probe.run_id for row in texts for _, answer in row.answers[:1]} == {run.pk}


def test_a_run_that_was_not_asked_the_texts_of_the_paper_says_so(analysed, rene, sample):  # noqa: F811
    run = analysed("perfect")
    page = page_of(rene, run, "sensitivity", run=sample.run.pk)
    assert page.context["paper_runs"] == [run, sample.run]
    assert text_of(page).count("not asked") == 6


def test_what_a_parser_writes_is_no_script(analysed, rene):  # noqa: F811
    run = analysed("perfect")
    ProbeAnswer.objects.filter(probe__run=run).update(logical_form="<script>alert(1)</script>")
    for name in PAGES:
        assert "<script>alert" not in page_of(rene, run, name).content.decode()


def test_the_list_of_probes_takes_few_queries(analysed, rene, django_assert_max_num_queries):  # noqa: F811
    run = analysed("perfect")
    with django_assert_max_num_queries(25):
        page_of(rene, run, "probes")
