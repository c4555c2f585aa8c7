"""Undo in the message about a change of who is in a world."""

from __future__ import annotations

import re

import pytest

from annotations.models import AuditEntry, Invitation, Membership, User
from annotations.models.worlds import Role
from annotations.people.members import roles_of, set_roles

PEOPLE = "/w/home/people/"
SENT = {"invite-roles": ["annotator"], "invite-places": "1", "invite-days": "7"}


@pytest.fixture
def as_admin(client, admin):
    client.force_login(admin)
    return client


def sealed_in(page) -> str:
    """The change that the button “Undo” of the page would take back."""
    (change,) = re.findall(r'name="change" value="([^"]+)"', page.content.decode())
    return change


def undo(client, page):
    return client.post(f"{PEOPLE}undo/", {"change": sealed_in(page)}, follow=True)


def test_a_change_of_roles_is_taken_back(world, annotator, as_admin):
    page = as_admin.post(f"{PEOPLE}{annotator.pk}/", {"roles": ["reviewer"]}, follow=True)
    assert roles_of(world, annotator) == ["reviewer"]
    after = undo(as_admin, page).content.decode()
    assert f"{annotator} is annotator of home again." in after
    assert roles_of(world, annotator) == ["annotator"]
    done = AuditEntry.objects.order_by("pk").values_list("what", "subject")
    assert list(done) == [
        ("change roles", f"{annotator}: reviewer"),
        ("undo a change of people", f"{annotator} is annotator of home again."),
    ]


def test_somebody_who_was_removed_comes_back_with_all_roles(world, annotator, as_admin):
    Membership.objects.create(world=world, user=annotator, role=Role.REVIEWER)
    page = as_admin.post(f"{PEOPLE}{annotator.pk}/", {"remove": "1"}, follow=True)
    assert roles_of(world, annotator) == []
    undo(as_admin, page)
    assert roles_of(world, annotator) == ["annotator", "reviewer"]


def test_somebody_who_was_added_goes_again(world, as_admin):
    nora = User.objects.create_user("nora")
    page = as_admin.post(PEOPLE, {"name": "nora", "roles": ["annotator"]}, follow=True)
    undo(as_admin, page)
    assert roles_of(world, nora) == []


def test_a_withdrawn_invitation_opens_again_until_the_same_day(world, as_admin):
    as_admin.post(f"{PEOPLE}invite/", SENT)
    invitation = Invitation.objects.get()
    until = invitation.expires_at
    page = as_admin.post(f"{PEOPLE}invitations/{invitation.pk}/withdraw/", follow=True)
    assert not Invitation.objects.open().exists()
    assert "The invitation is open again." in undo(as_admin, page).content.decode()
    assert Invitation.objects.open().get().expires_at == until


def test_an_old_button_does_not_open_what_was_withdrawn_once_more(world, as_admin):
    as_admin.post(f"{PEOPLE}invite/", SENT)
    withdraw = f"{PEOPLE}invitations/{Invitation.objects.get().pk}/withdraw/"
    page = as_admin.post(withdraw, follow=True)
    undo(as_admin, page)
    as_admin.post(withdraw)
    assert "Nothing was undone" in undo(as_admin, page).content.decode()
    assert not Invitation.objects.open().exists()


def test_invitations_of_a_former_admin_are_told_and_come_back(world, admin, superuser, client):
    Invitation.issue(world, [Role.ANNOTATOR], admin, 7, 1, "")
    client.force_login(superuser)
    page = client.post(f"{PEOPLE}{admin.pk}/", {"roles": ["annotator"]}, follow=True)
    assert "1 invitation of theirs is withdrawn." in page.content.decode()
    set_roles(world, admin, ["admin"], superuser)
    assert not Invitation.objects.open().exists()  # not by a later change
    set_roles(world, admin, ["annotator"], superuser)
    undo(client, page)
    assert Invitation.objects.open().count() == 1


def test_nothing_is_undone_where_somebody_was_faster(world, annotator, as_admin, admin):
    page = as_admin.post(f"{PEOPLE}{annotator.pk}/", {"roles": ["reviewer"]}, follow=True)
    set_roles(world, annotator, ["admin"], admin)
    after = undo(as_admin, page).content.decode()
    assert "Nothing was undone: somebody has changed the roles" in after
    assert roles_of(world, annotator) == ["admin"]


@pytest.mark.parametrize("change", ["", "x", "eyJ4IjoxfQ:1abcde:zzz"])
def test_what_no_button_has_sent_changes_nothing(change, world, as_admin):
    before = list(Membership.objects.values_list("user", "role"))
    page = as_admin.post(f"{PEOPLE}undo/", {"change": change}, follow=True).content.decode()
    assert "This can no longer be undone." in page
    assert list(Membership.objects.values_list("user", "role")) == before


def test_a_change_of_another_world_is_not_undone_here(
    world, other_world, annotator, as_admin, admin
):
    page = as_admin.post(f"{PEOPLE}{annotator.pk}/", {"roles": ["reviewer"]}, follow=True)
    Membership.objects.create(world=other_world, user=admin, role=Role.ADMIN)
    answer = as_admin.post(
        f"/w/{other_world.name}/people/undo/", {"change": sealed_in(page)}, follow=True
    )
    assert "This can no longer be undone." in answer.content.decode()
    assert roles_of(world, annotator) == ["reviewer"]


def test_whoever_takes_their_own_role_gets_no_button(world, admin, as_admin):
    Membership.objects.create(world=world, user=User.objects.create_user("berta"), role=Role.ADMIN)
    page = as_admin.post(f"{PEOPLE}{admin.pk}/", {"roles": ["annotator"]}, follow=True)
    assert "is now annotator of home." in page.content.decode()
    assert 'name="change"' not in page.content.decode()


def test_saving_the_same_roles_offers_nothing_to_undo(annotator, as_admin):
    page = as_admin.post(f"{PEOPLE}{annotator.pk}/", {"roles": ["annotator"]}, follow=True)
    assert 'name="change"' not in page.content.decode()
