"""Making a world by page."""

from __future__ import annotations

import pytest

from annotations.models import World


@pytest.fixture
def root(superuser, client):
    client.force_login(superuser)
    return client


def test_a_new_world_asks_for_its_files_next(root):
    answer = root.post("/worlds/new/", {"name": "laboratory", "description": "Ours."})
    assert answer.url == "/w/laboratory/import/"
    assert World.objects.get().description == "Ours."


@pytest.mark.parametrize(
    ("name", "code"), [("Upper Case", "invalid"), ("", "required"), ("home", "unique")]
)
def test_a_name_that_cannot_be_is_told(name, code, world, root):
    answer = root.post("/worlds/new/", {"name": name})
    assert answer.context["form"].has_error("name", code)
    assert World.objects.count() == 1


def test_whoever_may_make_worlds_finds_where(root):
    assert "/worlds/new/" in root.get("/").content.decode()
