"""/api/v1/worlds/<w>/members/, invitations/, audit-log/, and /api/v1/join/"""

from __future__ import annotations

import pytest

from annotations.models import AuditEntry, Invitation, User
from annotations.models.worlds import Role
from annotations.people.rate_limits import JOINING

MEMBERS = "worlds/home/members/"
INVITATIONS = "worlds/home/invitations/"


@pytest.fixture
def newcomer(db) -> User:
    return User.objects.create_user("nora", password="correct horse")


def test_roles_are_given_changed_and_taken(call_as, admin, reviewer, newcomer):
    sent = {"name": "nora", "roles": ["annotator", "reviewer"]}
    made = call_as(admin, "post", MEMBERS, sent)
    assert (made.status_code, made.json()["roles"]) == (201, sent["roles"])
    names = [row["name"] for row in call_as(reviewer, "get", MEMBERS).json()["results"]]
    assert names == ["adam", "nora", "rene"]
    address = f"{MEMBERS}{newcomer.pk}/"
    changed = call_as(admin, "patch", address, {"roles": ["admin"]}, if_match=made["ETag"])
    assert changed.json()["roles"] == ["admin"]
    late = call_as(admin, "patch", address, {"roles": ["reviewer"]}, if_match=made["ETag"])
    assert (late.status_code, late.json()["current"]["roles"]) == (412, ["admin"])
    assert call_as(admin, "delete", address, if_match="*").status_code == 204
    assert call_as(admin, "get", address).status_code == 404
    subjects = AuditEntry.objects.order_by("pk").values_list("what", "subject")
    assert list(subjects) == [
        ("create members", "nora: annotator and reviewer"),
        ("change member", "nora: admin"),
        ("delete member", "nora: removed"),
    ]


def test_somebody_unknown_is_not_added_and_the_last_admin_stays(call_as, admin):
    sent = {"name": "nobody", "roles": ["admin"]}
    assert call_as(admin, "post", MEMBERS, sent).json()["problems"][0]["field"] == "name"
    sent = {"name": "adam", "roles": ["owner"]}
    assert call_as(admin, "post", MEMBERS, sent).status_code == 400
    address = f"{MEMBERS}{admin.pk}/"
    assert call_as(admin, "delete", address, if_match="*").status_code == 409
    refused = call_as(admin, "patch", address, {"roles": ["reviewer"]}, if_match="*")
    assert (refused.status_code, admin.memberships.get().role) == (409, Role.ADMIN)


def test_somebody_joins_by_an_invitation(call_as, admin, newcomer):
    sent = {"roles": ["annotator"], "places": 1, "note": "Nora"}
    made = call_as(admin, "post", INVITATIONS, sent)
    assert (made.status_code, made["Cache-Control"]) == (201, "no-store")
    key = made.json()["key"]
    assert made.json()["link"].endswith(f"/join/{key}/")
    listed = call_as(admin, "get", INVITATIONS)
    assert key not in listed.content.decode()
    assert [row["note"] for row in listed.json()["results"]] == ["Nora"]
    joined = call_as(newcomer, "post", "join/", {"key": key})
    assert joined.json() == {"world": "home", "roles": ["annotator"]}
    assert newcomer.memberships.get().role == Role.ANNOTATOR
    assert call_as(admin, "post", "join/", {"key": key}).status_code == 404  # the place is taken


def test_an_invitation_is_withdrawn(call_as, admin, newcomer):
    made = call_as(admin, "post", INVITATIONS, {"roles": ["admin"]}).json()
    address = f"{INVITATIONS}{made['id']}/"
    assert call_as(admin, "delete", address).status_code == 428
    assert call_as(admin, "delete", address, if_match="*").status_code == 204
    assert not Invitation.objects.open().exists()
    assert call_as(newcomer, "post", "join/", {"key": made["key"]}).status_code == 404


def test_keys_are_not_guessed(call_as, newcomer):
    for _ in range(JOINING.limit):
        assert call_as(newcomer, "post", "join/", {"key": "guess"}).status_code == 404
    assert call_as(newcomer, "post", "join/", {"key": "guess"}).status_code == 429


def test_admins_read_who_did_what_in_their_world(call_as, admin, reviewer, superuser, other_world):
    AuditEntry.objects.create(world=other_world, world_name="laboratory", who_name="x", what="y")
    call_as(admin, "post", INVITATIONS, {"roles": ["reviewer"], "note": "Ben"})
    (row,) = call_as(admin, "get", "worlds/home/audit-log/", scope="read").json()["results"]
    assert (row["who"], row["through"], row["what"]) == ("adam", "notebook", "create invitations")
    assert row["subject"] == "reviewer: Ben"
    assert call_as(reviewer, "get", "worlds/home/audit-log/").status_code == 403
    worlds = [row["world"] for row in call_as(superuser, "get", "audit-log/").json()["results"]]
    assert worlds == ["home", "laboratory"]
    one = call_as(superuser, "get", "audit-log/?what=y").json()["results"]
    assert [row["world"] for row in one] == ["laboratory"]
