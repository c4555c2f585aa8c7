"""What every page shows around its content."""

from __future__ import annotations

import os
import re
import socket
import subprocess
from datetime import timedelta

import pytest
from django.utils import timezone

from annotations.models import StoredProblem, World
from gpsr_site.overview.counts import counts_of, counts_of_all
from gpsr_site.overview.workers import workers_now
from gpsr_site.pages.frame import LAST_WORLD
from gpsr_site.pages.rail import all_entries
from parser_service.models import Promotion, Worker
from parser_service.runs import run_requests


def worker(seconds_ago: float, host: str = "", process: int = 0) -> Worker:
    """A worker of this machine whose process has ended, unless it is said otherwise."""
    seen = timezone.now() - timedelta(seconds=seconds_ago)
    return Worker.objects.create(
        name="w1@host",
        host=host or socket.gethostname(),
        process_id=process or ended_process(),
        queue="cpu,quick",
        last_seen=seen,
    )


def ended_process() -> int:
    ended = subprocess.Popen(["true"])
    ended.wait()
    return ended.pid


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


def test_a_worker_that_is_late_lives_while_its_process_does(db):
    row = worker(seconds_ago=60, process=os.getpid())
    assert workers_now().is_alive
    row.last_seen -= timedelta(minutes=2)
    row.save()
    assert not workers_now().is_alive


@pytest.mark.parametrize(("seconds", "is_alive"), [(12, True), (25, False)])
def test_a_worker_elsewhere_may_be_late_by_some_beats(seconds, is_alive, db):
    worker(seconds_ago=seconds, host="elsewhere")
    assert workers_now().is_alive is is_alive


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


MOST_ENTRIES = 14
MOST_TABS = 6  # in one row


def entries_of(answer) -> dict[str, object]:
    return {entry.label: entry for group in answer.context["rail"] for entry in group.links}


def current_entries(answer) -> list[str]:
    return [label for label, entry in entries_of(answer).items() if entry.is_current]


def test_the_rail_shows_counts_the_current_page_and_what_waits(sample, annotator, client):
    StoredProblem.objects.create(
        world=sample.world, subject="grammar", severity="warning", message="m"
    )
    client.force_login(annotator)
    page = client.get("/w/home/templates/")
    entries = entries_of(page)
    assert current_entries(page) == ["Templates"]
    assert entries["Commands"].count == 3
    assert entries["Grammar"].dot.startswith("1 ")
    assert entries["Templates"].dot == ""


def test_the_groups_of_the_rail_follow_the_flow(sample, annotator, client):
    client.force_login(annotator)
    groups = client.get("/w/home/").context["rail"]
    assert [(group.heading, [entry.label for entry in group.links]) for group in groups] == [
        ("", ["Overview"]),
        ("Describe", ["Ontology", "Grammar", "Templates"]),
        ("Collect", ["Commands", "Paraphrases", "Label"]),
        ("Train and judge", ["Splits", "Runs", "Results", "Review"]),
        ("Use", ["Parse", "Robot"]),
        ("", ["Settings"]),
    ]
    assert sum(len(group.links) for group in groups) <= MOST_ENTRIES


@pytest.mark.parametrize(
    ("path", "tabs"),
    [
        ("results/", ["Results", "Compare", "Slices", "Learning curves"]),
        ("label/", ["Label", "Queue", "Utterances", "Label audit", "Guidelines"]),
        ("templates/", ["Templates", "By example", "Coverage"]),
        ("parse/", ["Parse", "Dialogue", "Several commands"]),
        ("predicates/robot/", ["Robot", "Recipes", "Promotion"]),
        ("people/", ["People", "Import and export", "Jobs", "Audit log", "World"]),
    ],
)
def test_what_belongs_together_is_one_place_with_tabs(path, tabs, sample, admin, client):
    client.force_login(admin)
    row = client.get(f"/w/home/{path}").context["tabs"]
    assert [tab.label for tab in row] == tabs
    for tab in row:
        page = client.get(tab.url)
        assert [each.label for each in page.context["tabs"] if each.is_current] == [tab.label]


@pytest.mark.parametrize(
    ("path", "views"),
    [
        (
            "coverage/",
            ["Coverage", "Templates without effect", "Conflicts", "Outside the grammar"],
        ),
        ("paraphrases/figures/", ["Figures", "Figures by form", "Contributors"]),
        ("queue/", ["Queue", "Agreement", "Progress", "Double labelling"]),
        ("utterances/", ["Utterances", "Uploads"]),
    ],
)
def test_pages_of_one_tab_are_a_second_row(path, views, sample, admin, client):
    client.force_login(admin)
    first = client.get(f"/w/home/{path}").context
    assert [view.label for view in first["views"]] == views
    for view in first["views"]:
        page = client.get(view.url).context
        assert [each.label for each in page["views"] if each.is_current] == [view.label]
        assert [each.label for each in page["tabs"] if each.is_current] == [views[0]]


def test_no_row_of_tabs_is_long():
    assert max(len(entry.tabs) for entry in all_entries()) <= MOST_TABS


def test_an_entry_leads_to_the_first_page_that_one_may_open(sample, annotator, reviewer, client):
    for person, page in ((annotator, "/w/home/label/"), (reviewer, "/w/home/queue/")):
        client.force_login(person)
        answer = client.get("/w/home/queue/agreement/")
        assert entries_of(answer)["Label"].url == page
        assert answer.context["trail"][0].url == page
        assert client.get(page).status_code == 200


def test_one_sees_only_the_tabs_that_one_may_open(sample, annotator, client):
    client.force_login(annotator)
    row = client.get("/w/home/people/").context["tabs"]
    assert [tab.label for tab in row] == ["People", "Import and export", "Jobs"]


def test_what_waits_on_a_tab_is_told_at_its_place_too(sample, admin, client):
    Promotion.objects.create(world=sample.world, run=sample.run, state="proposed", reason="r")
    client.force_login(admin)
    page = client.get("/w/home/predicates/robot/")
    assert "1 run proposed" in entries_of(page)["Robot"].dot
    (promotion,) = [tab for tab in page.context["tabs"] if tab.label == "Promotion"]
    assert promotion.dot.startswith("1 run")


def test_a_page_below_belongs_to_its_entry(sample, annotator, client):
    client.force_login(annotator)
    page = client.get(f"/w/home/runs/{sample.run.pk}/predictions/")
    assert current_entries(page) == ["Runs"]


@pytest.mark.parametrize("path", ["/docs/", "/docs/guides/splits/", "/account/", "/inbox/"])
def test_a_page_outside_of_worlds_keeps_the_rail_of_the_last_one(path, sample, annotator, client):
    client.force_login(annotator)
    assert entries_of(client.get(path)) == {}
    client.cookies[LAST_WORLD] = sample.world.name
    page = client.get(path)
    assert entries_of(page)["Commands"].count == 3 and current_entries(page) == []
    assert page.context["world"] is None


@pytest.mark.parametrize("name", ["laboratory", "nowhere", "", "a'; --", "\\303\\251"])
def test_the_last_world_is_one_that_the_reader_may_see(
    name, sample, other_sample, annotator, client
):
    client.cookies[LAST_WORLD] = sample.world.name
    assert entries_of(client.get("/docs/")) == {}  # nobody is logged in
    client.force_login(annotator)
    client.cookies[LAST_WORLD] = name
    page = client.get("/docs/")
    assert entries_of(page) == {} and "laboratory" not in page.content.decode()


def test_a_page_about_any_row_belongs_to_the_list_of_its_kind(sample, annotator, client):
    client.force_login(annotator)
    for kind, label in (("template", "Templates"), ("entity", "Ontology")):
        page = client.get(f"/w/home/history/{kind}/deleted/")
        assert current_entries(page) == [label]


def test_counts_are_those_of_the_world_alone(sample, other_sample):
    counts = counts_of(sample.world)
    assert (counts.entities, counts.templates, counts.commands, counts.forms) == (7, 2, 3, 2)
    assert (counts.splits, counts.runs, counts.evaluated, counts.runs_active) == (1, 1, 1, 0)


def test_counts_of_all_worlds_take_two_queries(sample, other_sample, django_assert_num_queries):
    with django_assert_num_queries(2):
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
