"""Who leaves keeps nothing: what they held in the work queue is free at once, whichever door they leave by."""

from __future__ import annotations

import io

import pytest
from django.contrib.contenttypes.models import ContentType
from django.test import Client
from django.urls import reverse

from annotations.exchange.world_export import world_archive
from annotations.exchange.world_import import import_world
from annotations.labelling.giving import assign, next_item, take
from annotations.labelling.item_answers import answer
from annotations.models import (
    ApiToken,
    Assignment,
    Invitation,
    Membership,
    Scope,
    WorkItem,
    WorkKind,
    World,
)
from annotations.models.queueing import Outcome
from annotations.models.worlds import Role
from annotations.people.accounts import set_open
from annotations.people.members import set_roles
from tests.annotations.labelling.queueing.conftest import BRING
from tests.conftest import client_of, member


@pytest.fixture(autouse=True)
def content_types(db):
    """The admin's log names content types; those of a test that emptied all tables are gone."""
    ContentType.objects.clear_cache()


@pytest.fixture
def held(world, queue, berta, admin) -> list[Assignment]:
    """What berta holds: an item that she took, and one that an admin gave her without end."""
    return [next_item(berta, world), assign(queue.last(), berta, by=admin)]


def as_admin(superuser, address: str, **sent):
    """Send the change form of Django's admin with one field changed."""
    client = client_of(superuser)
    form = client.get(address).context["adminform"].form
    formsets = client.get(address).context["inline_admin_formsets"]
    values = {name: form[name].value() for name in form.fields}
    for formset in (each.formset for each in formsets):
        for bound in (formset.management_form, *formset.forms):
            values.update({bound.add_prefix(name): bound[name].value() for name in bound.fields})
    values = {name: value for name, value in values.items() if value not in (None, False)}
    values |= {"date_joined_0": "2026-01-01", "date_joined_1": "00:00:00", **sent}
    answer = client.post(address, {name: value for name, value in values.items() if value})
    assert answer.status_code == 302, answer.context["errors"]


def leave_by_page(world, berta, admin, superuser):
    client_of(admin).post(reverse("member", args=["home", berta.pk]), {"remove": ""})


def leave_by_code(world, berta, admin, superuser):
    set_roles(world, berta, [Role.REVIEWER], by=admin)


def leave_by_rest(world, berta, admin, superuser):
    _, key = ApiToken.issue(admin, "notebook", scope=Scope.ADMIN)
    headers = {"authorization": f"Bearer {key}", "if-match": "*"}
    Client().delete(f"/api/v1/worlds/home/members/{berta.pk}/", headers=headers)


def leave_by_closed_account(world, berta, admin, superuser):
    set_open(berta, False, by=superuser)


def leave_by_inactive_account(world, berta, admin, superuser):
    as_admin(superuser, reverse("admin:annotations_user_change", args=[berta.pk]), is_active="")


def leave_by_admin_of_accounts(world, berta, admin, superuser):
    address = reverse("admin:annotations_user_change", args=[berta.pk])
    as_admin(superuser, address, **{"memberships-0-DELETE": "on"})


def leave_by_deleted_account(world, berta, admin, superuser):
    address = reverse("admin:annotations_user_delete", args=[berta.pk])
    client_of(superuser).post(address, {"post": "yes"})


def leave_by_many_deleted_accounts(world, berta, admin, superuser):
    values = {"action": "delete_selected", "_selected_action": berta.pk, "post": "yes"}
    client_of(superuser).post(reverse("admin:annotations_user_changelist"), values)


DOORS = [door for name, door in sorted(globals().items()) if name.startswith("leave_by_")]


@pytest.mark.parametrize("door", DOORS, ids=lambda door: door.__name__)
def test_what_they_held_is_free(door, world, held, berta, admin, superuser, annotator):
    door(world, berta, admin, superuser)
    assert not Membership.objects.filter(
        user__username="berta", user__is_active=True, role=Role.ANNOTATOR
    ).exists()
    assert not Assignment.objects.held().exists()
    assert {item.places for item in world.work_items.open()} == {1}
    assert {take(annotator, part.item).person for part in held} == {annotator}


def test_a_lower_role_keeps_what_it_may_do(world, queue, berta, annotator, admin):
    audits = queue.filter(pk=queue.first().pk)
    audits.update(kind=WorkKind.AUDIT)
    kept, lost = assign(audits.get(), berta, by=admin), assign(queue.last(), berta, by=admin)
    set_roles(world, berta, [Role.REVIEWER], by=admin)
    assert Assignment.objects.get(pk=kept.pk).outcome == Outcome.HELD
    assert Assignment.objects.get(pk=lost.pk).outcome == Outcome.RETURNED


@pytest.mark.parametrize("way", ["next", "take", "assign", "answer"])
def test_nobody_is_kept_out_by_who_has_left_by_no_door(way, world, held, berta, annotator, admin):
    Membership.objects.filter(user=berta).delete()
    item = held[1].item
    if way == "next":
        items = [next_item(annotator, world).item]
        while len(items) < 3:
            answer(items[-1].utterance, "unknown", "", annotator, 1)
            items.append(next_item(annotator, world).item)
        assert item in items
    elif way == "answer":
        answer(item.utterance, "form", BRING, annotator, 1)
        assert not WorkItem.objects.get(pk=item.pk).is_open
    else:
        given = take(annotator, item) if way == "take" else assign(item, annotator, by=admin)
        assert (given.person, WorkItem.objects.get(pk=item.pk).places) == (annotator, 0)


def test_a_world_that_is_imported_is_held_by_none_who_is_no_member(world, held, admin):
    archive = io.BytesIO(b"".join(world_archive(world)))
    import_world("copy", archive, by=admin)
    copy = World.objects.get(name="copy")
    assert not Assignment.objects.held().filter(item__world=copy).exists()
    assert {item.places for item in copy.work_items.all()} == {1}


def test_invitations_end_with_the_role_of_who_sent_them(world, superuser):
    adele = member(world, "adele", Role.ADMIN)
    values = {"world": world, "roles": ["annotator"], "expires_at": "2100-01-01T00:00Z"}
    Invitation.objects.create(created_by=adele, digest="1", **values)
    Invitation.objects.create(created_by=superuser, digest="2", **values)
    assert Invitation.objects.open().count() == 2
    Membership.objects.filter(user=adele).delete()
    assert [each.created_by for each in Invitation.objects.open()] == [superuser]
