"""What every page shows around its content."""

from __future__ import annotations

import re
from datetime import timedelta

import pytest
from django.utils import timezone

from annotations.models import Duty, StoredProblem, World
from annotations.models.worlds import DUTIES, Role
from gpsr_site.counts import counts_of, counts_of_all
from gpsr_site.flow import next_steps
from gpsr_site.workers import workers_now
from parser_service import requesting
from parser_service.models import Worker


def worker(seconds_ago: float) -> Worker:
    seen = timezone.now() - timedelta(seconds=seconds_ago)
    return Worker.objects.create(
        name="w1@host", host="host", process_id=1, queue="cpu", last_seen=seen
    )


def test_without_a_worker_every_page_says_so(house, annotator, client):
    client.force_login(annotator)
    for page in ("/", "/w/home/", "/w/home/runs/", "/banner/"):
        assert "A run that is started now would wait." in client.get(page).content.decode(), page


def test_a_worker_that_was_seen_lately_is_alive(house, annotator, client):
    worker(seconds_ago=3)
    client.force_login(annotator)
    assert "Worker idle" in client.get("/banner/").content.decode()
    assert "would wait" not in client.get("/w/home/").content.decode()


def test_a_worker_that_fell_silent_is_missed_within_ten_seconds(house, annotator, client):
    client.force_login(annotator)
    page = client.get("/w/home/").content.decode()
    seconds = float(re.search(r'/banner/" hx-trigger="every (\d+)s"', page)[1])
    worker(seconds_ago=9.9 - seconds)
    assert not workers_now().is_alive


def test_the_banner_counts_the_runs_that_wait(house, annotator, client):
    requesting.request(house.world, house.split, "seq2seq", send=False)
    client.force_login(annotator)
    answer = client.get("/banner/").content.decode()
    assert "1 run waits for one." in answer
    assert "No worker, 1 waiting" in answer


def test_the_banner_never_comes_from_a_cache(annotator, client):
    client.force_login(annotator)
    assert "no-store" in client.get("/banner/")["Cache-Control"]


def test_the_rail_shows_counts_the_current_page_and_what_waits(house, annotator, client):
    StoredProblem.objects.create(
        world=house.world, subject="grammar", severity="warning", message="m"
    )
    client.force_login(annotator)
    rail = client.get("/w/home/templates/").context["rail"]
    entries = {entry.label: entry for entry in rail}
    assert [entry.label for entry in rail if entry.is_current] == ["Templates"]
    assert entries["Commands"].count == 3
    assert entries["Grammar"].dot == "1 remarks to read"
    assert entries["Templates"].dot == ""


def test_a_page_below_belongs_to_its_entry(house, annotator, client):
    client.force_login(annotator)
    page = client.get(f"/w/home/runs/{house.run.pk}/predictions/")
    assert [entry.label for entry in page.context["rail"] if entry.is_current] == ["Results"]


def test_counts_are_those_of_the_world_alone(house, other_house):
    counts = counts_of(house.world)
    assert (counts.entities, counts.templates, counts.commands, counts.forms) == (7, 2, 3, 2)
    assert (counts.splits, counts.runs, counts.evaluated, counts.runs_active) == (1, 1, 1, 0)


def test_counts_of_all_worlds_take_one_query(house, other_house, django_assert_num_queries):
    with django_assert_num_queries(1):
        assert len(counts_of_all(World.objects.all())) == 2


def test_one_sees_only_the_worlds_that_one_belongs_to(house, other_house, annotator, client):
    client.force_login(annotator)
    page = client.get("/").content.decode()
    assert "/w/home/" in page
    assert "laboratory" not in page


def test_whoever_belongs_nowhere_is_told_what_to_do(db, django_user_model, client):
    client.force_login(django_user_model.objects.create_user("nora"))
    assert "Ask an admin to add you to one." in client.get("/").content.decode()


def test_an_empty_world_asks_its_admin_for_files(world):
    (step,) = next_steps(counts_of(world), DUTIES[Role.ADMIN])
    assert step.name == "import"
    assert next_steps(counts_of(world), DUTIES[Role.REVIEWER]) == []


def test_next_steps_are_those_that_the_person_may_take(house):
    names = [step.name for step in next_steps(counts_of(house.world), frozenset({Duty.VIEW}))]
    assert names == ["results"]


@pytest.mark.parametrize("path", ["", "runs/", "results/", "commands/", "splits/"])
def test_every_page_forbids_foreign_and_inline_scripts(path, house, annotator, client):
    client.force_login(annotator)
    answer = client.get(f"/w/home/{path}")
    policy = answer["Content-Security-Policy"]
    assert "script-src 'self'" in policy and "unsafe" not in policy
    page = answer.content.decode()
    assert "<script>" not in page and " style=" not in page and "onclick" not in page


def test_health_needs_no_log_in(db, client):
    assert client.get("/healthz").json() == {"status": "ok"}
