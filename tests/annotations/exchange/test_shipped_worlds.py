"""Worlds that come with this project are loaded by command, page and REST."""

from __future__ import annotations

import json
from io import StringIO

import pytest
from django.core.management import CommandError, call_command

from annotations import background
from annotations.background.carrying_out_jobs import carry_out
from annotations.background.progress import Unwatched
from annotations.exchange.shipped_worlds import SHIPPED_FOLDER, SHIPPED_WORLDS, load_world
from annotations.models import Job, JobKind, World


@pytest.fixture(autouse=True)
def no_worker(monkeypatch):
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)


def load(name: str, world: str) -> dict:
    out = StringIO()
    call_command("load_world", name, world=world, json=True, stdout=out)
    return json.loads(out.getvalue())


def test_each_folder_is_a_world_with_a_readme():
    folders = {each.name for each in SHIPPED_FOLDER.iterdir() if each.is_dir()}
    assert folders == set(SHIPPED_WORLDS)
    assert all((each.folder / "README.md").is_file() for each in SHIPPED_WORLDS.values())


def test_the_household_is_loaded_under_any_name_with_its_splits(db):
    loaded = load("household", "lab")
    assert (loaded["rows"]["commands"], loaded["rows"]["paraphrases"]) == (828, 787)
    assert set(loaded["splits"]) == {each.name for each in World.objects.get().splits.all()}


class Watching(Unwatched):
    """Keeps the fractions that it is told."""

    def __init__(self) -> None:
        self.fractions: list[float] = []

    def report(self, fraction: float, message: str) -> None:
        self.fractions.append(fraction)


def test_loading_tells_how_far_it_is(db):
    progress = Watching()
    load_world(SHIPPED_WORLDS["household"], "lab", progress=progress)
    assert progress.fractions == sorted(progress.fractions)
    assert progress.fractions[0] < 0.1 and progress.fractions[-1] >= 0.9
    assert len({round(each, 1) for each in progress.fractions}) > 5


def test_what_a_world_holds_is_not_overwritten(tiny_world):
    before = tiny_world.commands.count()
    with pytest.raises(CommandError):
        load("household", tiny_world.name)
    assert tiny_world.commands.count() == before
    with pytest.raises(CommandError):
        call_command("load_world", "nothing", world="lab")


def test_a_new_world_by_page_starts_with_a_shipped_one(transactional_db, superuser, client):
    client.force_login(superuser)
    assert all(name in client.get("/worlds/new/").content.decode() for name in SHIPPED_WORLDS)
    answer = client.post("/worlds/new/", {"name": "lab", "starts_with": "household"})
    job = Job.objects.get(kind=JobKind.LOAD_WORLD)
    assert answer.url == f"/jobs/{job.pk}/"
    assert World.objects.get(name="lab").commands.count() == 0
    carry_out(background.claim("a worker", "quick", Job, job))
    job.refresh_from_db()
    assert job.report["rows"]["commands"] == World.objects.get(name="lab").commands.count() == 828
    assert "828" in client.get(answer.url).content.decode()
    state = client.get(f"{answer.url}state/", headers={"HX-Request": "true"})
    assert state["HX-Refresh"] == "true"  # the rail counts what the world holds now


def test_a_new_world_by_rest_starts_with_a_shipped_one(call_as, superuser):
    made = call_as(superuser, "post", "worlds/", {"name": "lab", "starts_with": "competition"})
    assert (made.status_code, made.json()["kind"]) == (202, "load_world")
    assert made["Location"]
    unknown = call_as(superuser, "post", "worlds/", {"name": "hut", "starts_with": "castle"})
    assert unknown.status_code == 400 and not World.objects.filter(name="hut").exists()
