"""Who is in a world: everybody there sees it, its admins decide."""

from __future__ import annotations

import pytest

from annotations.models import Membership, User
from tests.conftest import member
from tests.notices import levels

PEOPLE = "/w/home/people/"


@pytest.fixture
def nora(db) -> User:
    """Somebody with an account and no world."""
    return User.objects.create_user("nora", password="correct horse")


@pytest.fixture
def as_admin(admin, client):
    client.force_login(admin)
    return client


def roles_of(world, user):
    rows = Membership.objects.filter(world=world, user=user)
    return sorted(rows.values_list("role", flat=True))


def test_members_see_each_other_and_no_button(world, annotator, admin, client):
    client.force_login(annotator)
    page = client.get(PEOPLE).content.decode()
    assert "anna" in page and "adam" in page
    main = page.partition('<main id="main"')[2].partition("</main>")[0]
    assert 'method="post"' not in main


def test_an_admin_adds_an_account_that_exists(world, nora, as_admin):
    answer = as_admin.post(PEOPLE, {"name": "nora", "roles": ["annotator", "reviewer"]})
    assert answer.url == PEOPLE
    assert roles_of(world, nora) == ["annotator", "reviewer"]


@pytest.mark.parametrize(
    ("values", "field", "code"),
    [
        ({"name": "nobody", "roles": ["annotator"]}, "name", None),
        ({"name": "nora"}, "roles", "required"),
        ({"name": "nora", "roles": ["owner"]}, "roles", "invalid_choice"),
        ({"name": "\0", "roles": ["annotator"]}, "name", "null_characters_not_allowed"),
    ],
)
def test_what_cannot_be_added_is_told(values, field, code, world, nora, as_admin):
    errors = as_admin.post(PEOPLE, values).context["form"].errors.as_data()
    assert {name: [each.code for each in told] for name, told in errors.items()} == {field: [code]}
    assert roles_of(world, nora) == []


def test_a_closed_account_is_not_added(world, nora, as_admin):
    User.objects.filter(pk=nora.pk).update(is_active=False)
    as_admin.post(PEOPLE, {"name": "nora", "roles": ["annotator"]})
    assert roles_of(world, nora) == []


def test_an_admin_changes_roles(world, annotator, as_admin):
    as_admin.post(f"{PEOPLE}{annotator.pk}/", {"roles": ["reviewer"]})
    assert roles_of(world, annotator) == ["reviewer"]


def test_an_admin_removes_somebody(world, annotator, as_admin, client):
    as_admin.post(f"{PEOPLE}{annotator.pk}/", {"roles": ["annotator"], "remove": "1"})
    assert roles_of(world, annotator) == []
    client.force_login(annotator)
    assert client.get("/w/home/").status_code == 404


@pytest.mark.parametrize("values", [{"remove": "1"}, {"roles": ["annotator"]}, {}])
def test_the_last_admin_stays(values, world, admin, as_admin):
    page = as_admin.post(f"{PEOPLE}{admin.pk}/", values, follow=True)
    assert levels(page) == ["error"]
    assert roles_of(world, admin) == ["admin"]


def test_an_admin_leaves_when_there_is_another(world, admin, as_admin):
    member(world, "berta", "admin")
    assert as_admin.post(f"{PEOPLE}{admin.pk}/", {"remove": "1"}).url == "/"
    assert roles_of(world, admin) == []


def test_an_admin_of_one_world_gives_no_roles_in_another(world, other_world, nora, as_admin):
    values = {"name": "nora", "roles": ["admin"]}
    assert as_admin.post("/w/laboratory/people/", values).status_code == 404


def test_somebody_elsewhere_is_not_changed_from_here(world, stranger, as_admin):
    assert as_admin.post(f"{PEOPLE}{stranger.pk}/", {"roles": ["annotator"]}).status_code == 404


def test_adding_keeps_the_roles_that_somebody_has(world, annotator, as_admin):
    as_admin.post(PEOPLE, {"name": "anna", "roles": ["reviewer"]})
    assert roles_of(world, annotator) == ["annotator", "reviewer"]
