"""The audit log: whatever somebody changes is in it, with no secret; admins read and filter it."""

from __future__ import annotations

from io import StringIO

import pytest
from django.core.management import call_command

from annotations.models import ApiToken, AuditEntry, Invitation, Scope
from annotations.models.worlds import Role
from tests.conftest import client_of

LOG = "/w/home/log/"


def entries() -> list[tuple[str, str, str]]:
    rows = AuditEntry.objects.order_by("pk")
    return list(rows.values_list("who_name", "what", "subject"))


def test_what_an_admin_does_to_members_is_in_it(adam, annotator, world):
    adam.post(f"/w/home/people/{annotator.pk}/", {"roles": ["reviewer"]})
    adam.post(f"/w/home/people/{annotator.pk}/", {"remove": "1"})
    assert entries() == [
        ("adam", "change roles", "anna: reviewer"),
        ("adam", "change roles", "anna: removed"),
    ]
    assert {entry.world for entry in AuditEntry.objects.all()} == {world}


def test_the_way_of_a_new_person_is_in_it_without_a_secret(adam, admin, client, world):
    _, key = Invitation.issue(world, [Role.ANNOTATOR], admin, 7, 1, "")
    secret = "a battery staple"
    sent = {"username": "nora", "password1": secret, "password2": secret}
    client.post(f"/join/{key}/", sent)
    token = client.post(
        "/account/tokens/new/", {"name": "robot", "scope": "read", "days": "9"}, follow=True
    )
    client.post("/account/sessions/end/")
    assert entries() == [
        ("nora", "join", "as annotator"),
        ("nora", "make a token", "robot (read)"),
    ]
    assert AuditEntry.objects.first().world_name == ""
    assert AuditEntry.objects.last().world == world
    written = str(list(AuditEntry.objects.values()))
    for each in (key, secret, token.context["key"]):
        assert each not in written


def test_a_program_is_named_by_its_token(annotator, client, world):
    _, key = ApiToken.issue(annotator, "robot", scope=Scope.ANNOTATE)
    sent, headers = {"texts": ["bring me tea"]}, {"authorization": f"Bearer {key}"}
    url = "/api/v1/worlds/home/utterances/"
    client.post(url, sent, content_type="application/json", headers=headers)
    entry = AuditEntry.objects.get()
    assert (entry.who, entry.through, entry.world) == (annotator, "robot", world)
    assert entry.what == "create utterances"


def test_a_token_that_was_made_on_the_command_line_is_called_a_token(adam, client, world):
    call_command("issue_token", "adam", "--scope", "annotate", stdout=(out := StringIO()))
    headers = {"authorization": f"Bearer {out.getvalue().strip()}"}
    sent, url = {"texts": ["bring me tea"]}, "/api/v1/worlds/home/utterances/"
    client.post(url, sent, content_type="application/json", headers=headers)
    page = adam.get(LOG).content.decode()
    assert "with the token command line" in page and "by command line" not in page


def test_what_is_read_refused_or_only_checked_is_not_in_it(adam, anna, world):
    adam.get("/w/home/people/")
    adam.post("/w/home/people/", {"name": "nobody", "roles": ["annotator"]})
    anna.post("/w/home/people/", {"name": "anna", "roles": ["admin"]})
    adam.post("/w/home/people/invite/", {})
    assert entries() == []


@pytest.mark.parametrize(
    "path",
    [
        "/w/home/queue/next/",
        "/w/home/templates/preview/",
        "/inbox/",
        "/api/v1/notices/read/",
        "/api/v1/worlds/home/work-items/next/",
    ],
)
def test_what_others_do_not_see_is_not_in_it(path, anna, world):
    assert anna.post(path, headers={"hx-request": "true"}).status_code < 400
    assert entries() == []


def test_logging_in_is_in_it(annotator, client):
    client.post("/login/", {"username": "anna", "password": "correct horse"})
    assert entries() == [("anna", "log in", "")]


def add(world, who, what, subject=""):
    return AuditEntry.objects.create(
        world=world, world_name=str(world), who_name=who, what=what, subject=subject
    )


def listed(client, query="", url=LOG):
    return [entry.what for entry in client.get(f"{url}?{query}").context["listing"].rows]


def test_admins_filter_it(adam, world, other_world):
    add(world, "anna", "label", "utterance 3")
    add(world, "rene", "cancel a run", "run 4")
    add(other_world, "stina", "invite")
    assert listed(adam) == ["cancel a run", "label"]
    assert listed(adam, "who_name=anna") == ["label"]
    assert listed(adam, "what=cancel+a+run") == ["cancel a run"]
    assert listed(adam, "q=utterance") == ["label"]
    assert listed(adam, "since=2999-01-01") == []
    assert listed(adam, "sort=-when") == ["label", "cancel a run"]


def test_administrators_of_the_site_see_all_of_it(superuser, admin, world, other_world):
    add(world, "anna", "label")
    add(other_world, "stina", "invite")
    assert listed(client_of(superuser), url="/log/") == ["invite", "label"]
    assert client_of(admin).get("/log/").status_code == 403


def test_it_outlives_person_and_world(annotator, world):
    entry = AuditEntry.objects.create(
        world=world, world_name="home", who=annotator, who_name="anna", what="label"
    )
    annotator.delete()
    world.delete()
    entry.refresh_from_db()
    assert (entry.world, entry.world_name, entry.who, entry.who_name) == (
        None,
        "home",
        None,
        "anna",
    )
