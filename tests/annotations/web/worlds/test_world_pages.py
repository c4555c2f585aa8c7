"""Making a world by page."""

from __future__ import annotations

import pytest
from django.test import Client

from annotations.models import Job, User, World
from annotations.models.background import JobKind, Status
from annotations.models.worlds import Role
from annotations.people.members import add_roles, admins_of
from tests.notices import levels


@pytest.fixture
def root(superuser, client):
    client.force_login(superuser)
    return client


def test_a_new_world_says_what_to_do_first(root):
    answer = root.post("/worlds/new/", {"name": "laboratory", "description": "Ours."})
    assert answer.url == "/w/laboratory/"
    created = World.objects.get()
    assert created.description == "Ours."
    assert admins_of(created) == [answer.wsgi_request.user.username]


@pytest.mark.parametrize(
    ("name", "code"), [("Upper Case", "invalid"), ("", "required"), ("home", "unique")]
)
def test_a_name_that_cannot_be_is_told(name, code, world, root):
    answer = root.post("/worlds/new/", {"name": name})
    form = answer.context["form"]
    assert form.has_error("name", code)
    assert any("upper-case" in each for each in form.errors["name"]) == (code == "invalid")
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


@pytest.mark.parametrize("status", [Status.QUEUED, Status.RUNNING])
def test_a_world_keeps_its_name_while_jobs_look_for_it(status, sample, admin, client):
    """An import by the old name would make a world of that name, or change one that has taken it."""
    job = Job.objects.create(
        kind=JobKind.GENERATE, world=sample.world, world_name="home", status=status
    )
    client.force_login(admin)
    answer = client.post(PAGE, {"name": "flat", "description": "Two rooms."})
    assert answer.status_code == 422 and answer.context["form"].has_error("name")
    assert client.post(PAGE, {"name": "home", "description": "Two rooms."}).status_code == 302
    job.refresh_from_db()
    sample.world.refresh_from_db()
    assert (job.world_name, sample.world.name, sample.world.description) == (
        "home",
        "home",
        "Two rooms.",
    )


def test_a_question_of_a_renamed_world_is_answered_in_it(sample, admin, client):
    asked = Job.objects.create(
        kind=JobKind.IMPORT_PAIRS,
        world=sample.world,
        world_name="home",
        status=Status.SUCCEEDED,
        report={"is_waiting": True},
    )
    client.force_login(admin)
    client.post(PAGE, {"name": "flat", "description": ""})
    asked.refresh_from_db()
    assert asked.world_name == "flat"


def test_only_who_may_delete_the_world_finds_the_button(sample, admin, superuser, client):
    for user, is_there in ((admin, False), (superuser, True)):
        client.force_login(user)
        assert ("/w/home/delete/" in client.get(PAGE).content.decode()) is is_there


def values_of(client):
    """What the form of the page sends as it stands."""
    form = client.get(PAGE).context["form"]
    return {field.name: field.value() for field in form}


@pytest.fixture
def berta(sample):
    account = User.objects.create_user("berta")
    add_roles(sample.world, account, [Role.ADMIN])
    client = Client()
    client.force_login(account)
    return client


def test_two_admins_who_change_other_fields_lose_nothing(sample, admin, client, berta):
    client.force_login(admin)
    mine, theirs = values_of(client), values_of(berta)
    berta.post(PAGE, {**theirs, "world": sample.world.pk, "name": "flat"})
    answer = client.post(PAGE, {**mine, "world": sample.world.pk, "description": "Two rooms."})
    assert answer.url == "/w/flat/world/"
    sample.world.refresh_from_db()
    assert (sample.world.name, sample.world.description) == ("flat", "Two rooms.")


def test_the_second_of_two_admins_reads_what_the_first_has_saved(sample, admin, client, berta):
    client.force_login(admin)
    mine, theirs = values_of(client), values_of(berta)
    berta.post(PAGE, {**theirs, "description": "One room."})
    answer = client.post(PAGE, {**mine, "description": "Two rooms."})
    assert answer.status_code == 422
    (error,) = answer.context["form"].errors["description"]
    assert error.startswith(
        "berta has saved another description in the meantime. It is “One room.”"
    )
    shown = {field.name: field.value() for field in answer.context["form"]}
    assert shown["description"] == "Two rooms."
    sample.world.refresh_from_db()
    assert sample.world.description == "One room."
    assert client.post(PAGE, shown).status_code == 302
    sample.world.refresh_from_db()
    assert sample.world.description == "Two rooms."


def test_the_same_description_twice_is_no_clash(sample, admin, client, berta):
    client.force_login(admin)
    mine = values_of(client)
    berta.post(PAGE, {**mine, "description": "One\nroom."})
    assert client.post(PAGE, {**mine, "description": "One\r\nroom."}).status_code == 302


@pytest.mark.parametrize("key", ["", "x", "-1", "9" * 30, "²"])
def test_a_world_that_is_not_the_reader_s_is_not_found_by_its_key(
    key, sample, other_world, admin, client
):
    client.force_login(admin)
    values = {"name": "mine", "description": ""}
    assert client.post("/w/nowhere/world/", {**values, "world": key}).status_code == 404
    assert client.post("/w/nowhere/world/", {**values, "world": other_world.pk}).status_code == 404
