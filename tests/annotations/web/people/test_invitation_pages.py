"""Invitations: an admin makes a link, whoever has it joins, with an account or with a new one."""

from __future__ import annotations

from datetime import timedelta

import pytest
from django.test import Client
from django.utils import timezone

from annotations.models import Invitation, Membership, User
from annotations.models.worlds import Role
from annotations.people.invitations import InvitationOver, NameTaken, join, sign_up
from annotations.people.rate_limits import JOINING

PEOPLE = "/w/home/people/"
SENT = {"invite-roles": ["annotator"], "invite-places": "1", "invite-days": "7"}
NEW = {"username": "nora", "password1": "a battery staple", "password2": "a battery staple"}


@pytest.fixture
def invited(world, admin):
    """A function that returns an invitation and the address that its link leads to."""

    def invite(places: int = 1, roles: tuple[Role, ...] = (Role.ANNOTATOR,), by: User = admin):
        invitation, key = Invitation.issue(world, list(roles), by, 7, places, "")
        return invitation, f"/join/{key}/"

    return invite


def roles_of(world, name):
    rows = Membership.objects.filter(world=world, user__username=name)
    return sorted(rows.values_list("role", flat=True))


def test_an_admin_gets_a_link_that_is_shown_once_and_not_stored(adam, client, world):
    sent = adam.post(f"{PEOPLE}invite/", {**SENT, "invite-note": "Nora"})
    assert sent.status_code == 302 and sent.url == PEOPLE
    answer = adam.get(PEOPLE)
    link = answer.context["link"]
    assert link in answer.content.decode()
    assert "no-store" in answer["Cache-Control"]
    key = link.rstrip("/").rsplit("/", 1)[1]
    assert all(key not in str(value) for value in Invitation.objects.values().get().values())
    again = adam.get(PEOPLE).content.decode()
    assert "Nora: annotator" in again and key not in again
    assert client.post(f"/join/{key}/", NEW).url == "/w/home/"


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("invite-roles", "owner"),
        ("invite-roles", ""),
        ("invite-places", "0"),
        ("invite-places", "201"),
        ("invite-days", "61"),
        ("invite-days", ""),
    ],
)
def test_what_cannot_be_offered_is_refused(field, value, adam):
    answer = adam.post(f"{PEOPLE}invite/", {**SENT, field: value})
    assert answer.status_code == 422
    assert list(answer.context["invitation_form"].errors) == [field.removeprefix("invite-")]
    assert not Invitation.objects.exists()


def test_members_who_are_no_admins_see_no_invitations(invited, anna):
    invited()
    assert "Withdraw" not in anna.get(PEOPLE).content.decode()


def test_a_new_account_joins_and_is_logged_in(invited, client, world):
    invitation, link = invited(roles=(Role.ANNOTATOR, Role.REVIEWER))
    assert (
        "adam invites you to join home as annotator and reviewer."
        in client.get(link).content.decode()
    )
    assert client.post(link, NEW).url == "/w/home/"
    assert client.get("/w/home/").status_code == 200
    assert roles_of(world, "nora") == ["annotator", "reviewer"]
    invitation.refresh_from_db()
    assert invitation.joined == 1


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"username": "ADAM"}, "username"),
        ({"username": "no space"}, "username"),
        ({"password2": "another"}, "password2"),
        ({"password1": "password", "password2": "password"}, "password2"),
        ({"password1": "a" * 1001, "password2": "a" * 1001}, "password1"),
    ],
)
def test_an_account_that_cannot_be_is_told_and_takes_no_place(changes, field, invited, client):
    invitation, link = invited()
    answer = client.post(link, {**NEW, **changes})
    assert answer.status_code == 422 and field in answer.context["form"].errors
    assert User.objects.count() == 1
    invitation.refresh_from_db()
    assert invitation.joined == 0


def test_somebody_with_an_account_joins_with_one_button(invited, client, world, stranger):
    _, link = invited()
    client.force_login(stranger)
    page = client.get(link)
    assert page.status_code == 200 and "stina" in page.content.decode()
    assert "password1" not in page.content.decode()
    assert client.post(link).url == "/w/home/"
    assert roles_of(world, "stina") == ["annotator"]


def test_a_link_for_one_is_over_after_one(invited, client):
    _, link = invited()
    client.post(link, NEW)
    answer = Client().get(link)
    assert answer.status_code == 404
    assert "<form" not in answer.content.decode()


def test_the_last_place_is_taken_once(invited, stranger):
    invitation, _ = invited()
    sign_up(invitation, "nora", "a battery staple")
    with pytest.raises(InvitationOver):
        join(invitation, stranger)  # read while there was a place
    with pytest.raises(InvitationOver):
        sign_up(invitation, "nils", "a battery staple")
    assert not User.objects.filter(username="nils").exists()


def test_whoever_is_in_already_takes_no_place(invited, anna):
    invitation, link = invited()
    assert anna.post(link).url == "/w/home/"
    invitation.refresh_from_db()
    assert invitation.joined == 0


@pytest.mark.parametrize("how", ["expired", "withdrawn", "closed", "demoted", "deleted"])
def test_an_invitation_ends(how, invited, client, world, admin, adam):
    invitation, link = invited()
    if how == "expired":
        Invitation.objects.update(expires_at=timezone.now() - timedelta(seconds=1))
    elif how == "withdrawn":
        adam.post(f"{PEOPLE}invitations/{invitation.pk}/withdraw/")
    elif how == "closed":
        User.objects.filter(pk=admin.pk).update(is_active=False)
    elif how == "demoted":
        Membership.objects.create(
            world=world, user=User.objects.create_user("berta"), role=Role.ADMIN
        )
        adam.post(f"{PEOPLE}{admin.pk}/", {"roles": ["annotator"]})
    else:
        world.deletion_requested_at = timezone.now()
        world.save()
    assert client.post(link, NEW).status_code == 404
    assert not User.objects.filter(username="nora").exists()


@pytest.mark.parametrize("key", ["x" * 43, "%00", "%ff", "a%2Fb"])
def test_a_wrong_link_leads_nowhere(key, client, db):
    assert client.get(f"/join/{key}/").status_code == 404


def test_one_address_cannot_try_many_links(client, invited):
    _, link = invited()
    for _ in range(JOINING.limit):
        client.get("/join/guess/")
    answer = client.post(link, NEW)
    assert answer.status_code == 429 and answer["Retry-After"] == "600"


def test_a_class_behind_one_address_joins(invited, world):
    _, link = invited(places=JOINING.limit + 5)
    for number in range(JOINING.limit + 5):
        assert Client().post(link, {**NEW, "username": f"pupil{number}"}).status_code == 302


@pytest.mark.parametrize(
    ("held", "wanted"), [("Carla", "carla"), ("émile", "ÉMILE"), ("nora", "Nora")]
)
def test_a_name_that_somebody_has_in_another_case_is_taken(held, wanted, invited, client):
    User.objects.create_user(held)
    invitation, link = invited()
    answer = client.post(link, {**NEW, "username": wanted})
    assert answer.status_code == 422 and answer.context["form"].errors["username"]
    with pytest.raises(NameTaken):
        sign_up(invitation, wanted, "a battery staple")
    assert User.objects.filter(username__in=[held, wanted]).count() == 1


def test_a_link_that_only_this_computer_opens_is_told_so(adam):
    for host, is_told in (("localhost", True), ("testserver", False)):
        adam.post(f"{PEOPLE}invite/", SENT, headers={"host": host})
        page = adam.get(PEOPLE, headers={"host": host}).content.decode()
        assert ("ALLOWED_HOSTS" in page) is is_told
