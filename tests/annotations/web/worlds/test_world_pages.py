"""Making a world by page."""

from __future__ import annotations

import pytest

from annotations.models import World
from annotations.people.members import admins_of
from tests.notices import levels


@pytest.fixture
def root(superuser, client):
    client.force_login(superuser)
    return client


def test_a_new_world_asks_for_its_files_next(root):
    answer = root.post("/worlds/new/", {"name": "laboratory", "description": "Ours."})
    assert answer.url == "/w/laboratory/import/"
    created = World.objects.get()
    assert created.description == "Ours."
    assert admins_of(created) == [answer.wsgi_request.user.username]


@pytest.mark.parametrize(
    ("name", "code"), [("Upper Case", "invalid"), ("", "required"), ("home", "unique")]
)
def test_a_name_that_cannot_be_is_told(name, code, world, root):
    answer = root.post("/worlds/new/", {"name": name})
    assert answer.context["form"].has_error("name", code)
    assert World.objects.count() == 1


def test_whoever_may_make_worlds_finds_where(root):
    assert "/worlds/new/" in root.get("/").content.decode()


PAGE = "/w/home/world/"


def test_an_admin_renames_and_describes_the_world(sample, admin, client):
    client.force_login(admin)
    answer = client.post(PAGE, {"name": "flat", "description": "Two rooms."}, follow=True)
    assert levels(answer) == ["success"] and answer.redirect_chain == [("/w/flat/world/", 302)]
    sample.world.refresh_from_db()
    assert (sample.world.name, sample.world.description) == ("flat", "Two rooms.")
    assert client.get("/w/home/").status_code == 404


@pytest.mark.parametrize("name", ["laboratory", "Upper Case", ""])
def test_a_name_that_cannot_be_changes_nothing(name, sample, other_world, admin, client):
    client.force_login(admin)
    answer = client.post(PAGE, {"name": name, "description": "Changed."})
    assert answer.status_code == 422 and answer.context["form"].has_error("name")
    sample.world.refresh_from_db()
    assert (sample.world.name, sample.world.description) == ("home", "A flat with one robot.")
    assert (
        'href="/w/home/templates/"' in answer.content.decode()
    )  # the frame is still that of the world


def test_only_who_may_delete_the_world_finds_the_button(sample, admin, superuser, client):
    for user, is_there in ((admin, False), (superuser, True)):
        client.force_login(user)
        assert ("/w/home/delete/" in client.get(PAGE).content.decode()) is is_there
