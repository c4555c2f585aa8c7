"""What every page shows around its content."""

from __future__ import annotations

import re
from datetime import timedelta

import pytest
from django.utils import timezone

from annotations.models import StoredProblem, World
from gpsr_site.overview.counts import counts_of, counts_of_all
from gpsr_site.overview.workers import workers_now
from gpsr_site.pages.frame import PLACES
from parser_service.models import Worker
from parser_service.runs.requests import run_requests
from tests.gpsr_site.routes.listing import ROUTES_OF_WORLDS


def worker(seconds_ago: float) -> Worker:
    seen = timezone.now() - timedelta(seconds=seconds_ago)
    return Worker.objects.create(
        name="w1@host", host="host", process_id=1, queue="cpu,quick", last_seen=seen
    )


def test_without_a_worker_every_page_says_so(sample, annotator, client):
    client.force_login(annotator)
    for page in ("/", "/w/home/", "/w/home/runs/", "/banner/"):
        answer = client.get(page).content.decode()
        assert 'data-state="none"' in answer and workers_now().sentence in answer, page
        assert "banner-line error" in answer, page


def test_a_worker_that_was_seen_lately_is_alive(sample, annotator, client):
    worker(seconds_ago=3)
    client.force_login(annotator)
    assert 'data-state="idle"' in client.get("/banner/").content.decode()
    assert "banner-line error" not in client.get("/w/home/").content.decode()


def test_a_worker_that_fell_silent_is_missed_within_ten_seconds(sample, annotator, client):
    client.force_login(annotator)
    page = client.get("/w/home/").content.decode()
    seconds = float(re.search(r'/banner/" hx-trigger="every (\d+)s"', page)[1])
    worker(seconds_ago=9.9 - seconds)
    assert not workers_now().is_alive


def test_the_banner_counts_the_runs_that_wait(sample, annotator, client):
    run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    client.force_login(annotator)
    answer = client.get("/banner/").content.decode()
    workers = workers_now()
    assert sum(workers.waiting.values()) == 1
    assert "1 run " in workers.sentence and "1 " in workers.summary
    assert workers.sentence in answer and workers.summary in answer


def test_the_banner_never_comes_from_a_cache(annotator, client):
    client.force_login(annotator)
    assert "no-store" in client.get("/banner/")["Cache-Control"]


def test_the_rail_shows_counts_the_current_page_and_what_waits(sample, annotator, client):
    StoredProblem.objects.create(
        world=sample.world, subject="grammar", severity="warning", message="m"
    )
    client.force_login(annotator)
    rail = client.get("/w/home/templates/").context["rail"]
    entries = {entry.label: entry for entry in rail}
    assert [entry.label for entry in rail if entry.is_current] == ["Templates"]
    assert entries["Commands"].count == 3
    assert entries["Grammar"].dot.startswith("1 ")
    assert entries["Templates"].dot == ""


def test_a_page_below_belongs_to_its_entry(sample, annotator, client):
    client.force_login(annotator)
    page = client.get(f"/w/home/runs/{sample.run.pk}/predictions/")
    assert [entry.label for entry in page.context["rail"] if entry.is_current] == ["Results"]


def test_a_page_about_any_row_belongs_to_the_list_of_its_kind(sample, annotator, client):
    client.force_login(annotator)
    for kind, label in (("template", "Templates"), ("entity", "Ontology")):
        page = client.get(f"/w/home/history/{kind}/deleted/")
        assert [entry.label for entry in page.context["rail"] if entry.is_current] == [label]


def test_every_page_of_a_world_belongs_to_one_entry():
    """What is no page of its own: parts of pages, files, actions, and the search over all kinds."""
    parts = {
        "coverage",
        "template_check",
        "template_preview",
        "template_consequences",
        "generate",
        "near_duplicates",
    }
    parts |= {"production_check", "production_preview", "predicate_preview", "class_colours"}
    parts |= {"download_part", "recipe_book", "recipe_preview", "primitive_preview"}
    parts |= {"template_completion", "template_suggestions", "template_repair"}
    parts |= {"template_duplicate", "delete_row"}
    parts |= {"runs_table", "run_state", "run_charts", "run_curves", "run_cancel", "results_table"}
    parts |= {"label_item", "label_answer", "label_check", "label_mend", "label_take_back"}
    parts |= {"history", "deleted", "comments", "draft", "rename"}  # of rows of any kind
    parts |= {"comment", "comment_delete", "comment_restore"}
    parts |= {"queue_next", "queue_act", "queue_settle", "queue_ask", "queue_assign"}
    parts |= {name for name in ROUTES_OF_WORLDS if name.startswith("api:")}
    parts |= {"audit_start", "audit_item", "audit_decide", "audit_check", "audit_take_back"}
    parts |= {"label_send"}
    parts |= {"slice_rename", "slice_delete"}
    parts |= {"analysis_state", "analysis_start", "analysis_cancel", "tryout_ask"}
    parts |= {"results_csv", "results_latex", "results_json", "download", "search", "member"}
    parts |= {"invite", "invitation_withdraw"}
    parts |= {"review_tag", "review_note", "review_doubt"}
    parts |= {"error_category_move", "error_category_delete"}
    parts |= {"results_csv", "download", "search", "member"}
    parts |= {"example_send", "predictions_send", "paraphrase_label", "paraphrase_check"}
    parts |= {"split_changes", "split_renew", "split_runs", "run_retrain", "run_report"}
    parts |= {"compare_report"}
    parts |= {"dialogue_keep", "offered_entity_decide", "plan_schema"}
    parts |= {"learning_curves_table", "learning_curves_data", "learning_curve_start"}
    parts |= {"paraphrase_runs", "paraphrase_runs_start"}
    parts |= {"playground_ask", "joint_plan_ask", "playground_wrong", "parser_state"}
    parts |= {"guidelines_preview", "utterances_delete", "utterances_restore"}
    parts |= {"upload_undo", "upload_redo", "campaign_state", "campaign_act"}
    parts |= {"submission_decide", "submissions_decide", "submissions_take_back"}
    parts |= {"promotion_promote", "promotion_roll_back", "promotion_decline"}
    names = [name for place in PLACES for name in (place.page, *place.pages_below)]
    assert len(names) == len(set(names))
    assert set(names) - {"job"} == ROUTES_OF_WORLDS - parts


def test_counts_are_those_of_the_world_alone(sample, other_sample):
    counts = counts_of(sample.world)
    assert (counts.entities, counts.templates, counts.commands, counts.forms) == (7, 2, 3, 2)
    assert (counts.splits, counts.runs, counts.evaluated, counts.runs_active) == (1, 1, 1, 0)


def test_counts_of_all_worlds_take_one_query(sample, other_sample, django_assert_num_queries):
    with django_assert_num_queries(1):
        assert len(counts_of_all(World.objects.all())) == 2


def test_counts_of_no_world_are_none(db):
    assert counts_of_all(World.objects.none()) == {}


def test_one_sees_only_the_worlds_that_one_belongs_to(sample, other_sample, annotator, client):
    client.force_login(annotator)
    page = client.get("/").content.decode()
    assert "/w/home/" in page
    assert "laboratory" not in page


def test_whoever_belongs_nowhere_is_told_what_to_do(db, django_user_model, client):
    client.force_login(django_user_model.objects.create_user("nora"))
    page = client.get("/").content.decode()
    assert '<div class="empty">' in page and 'href="/worlds/new/"' not in page


@pytest.mark.parametrize("path", ["", "runs/", "results/", "commands/", "splits/"])
def test_every_page_forbids_foreign_and_inline_scripts(path, sample, annotator, client):
    client.force_login(annotator)
    answer = client.get(f"/w/home/{path}")
    policy = answer["Content-Security-Policy"]
    assert "script-src 'self'" in policy and "unsafe" not in policy
    page = answer.content.decode()
    assert "<script>" not in page and " style=" not in page and "onclick" not in page


def test_health_needs_no_log_in(db, client):
    assert client.get("/healthz").json() == {"status": "ok"}
