"""What people take from the work queue, what admins give them, shares, and what is asked for."""

from __future__ import annotations

import pytest

from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import refill, set_share
from annotations.labelling.giving import take
from annotations.models import Utterance, WorkItem, WorkKind

ITEMS = "worlds/home/work-items/"
SETTINGS = "worlds/home/queue-settings/"


@pytest.fixture
def items(tiny_world, annotator):
    collect(tiny_world, ["bring me tea", "go to the kitchen"], by=annotator)
    refill(tiny_world)
    return tiny_world.work_items.order_by("pk")


def test_an_item_is_taken_and_skipped(call_as, items, annotator, reviewer, admin):
    address = f"{ITEMS}{items[0].pk}/"
    taken = call_as(annotator, "post", f"{address}take/").json()
    assert [part["person"] for part in taken["assignments"]] == ["anna"]
    assert call_as(admin, "post", f"{address}take/").status_code == 409
    assert call_as(reviewer, "post", f"{address}take/").status_code == 409
    assert call_as(annotator, "post", f"{address}skip/").json()["places"] == 1
    assert call_as(annotator, "post", f"{address}skip/").status_code == 409


def test_admins_say_who_does_what(call_as, items, annotator, admin):
    address = f"{ITEMS}{items[0].pk}/"
    assert call_as(admin, "post", f"{address}assign/", {"person": "who"}).status_code == 400
    given = call_as(admin, "post", f"{address}assign/", {"person": "anna"}).json()
    assert given["assignments"][0]["leased_until"] is None
    assert call_as(admin, "post", f"{address}assign/", {"person": "adam"}).status_code == 409
    assert call_as(admin, "post", f"{address}withdraw/").json()["places"] == 1
    many = {"person": "anna", "count": 10}
    some = call_as(admin, "post", f"{ITEMS}assign/?q=kitchen", many)
    assert some.json() == {"given": 1}
    rest = call_as(admin, "post", f"{ITEMS}assign/", {**many, "person": "adam"})
    assert rest.json() == {"given": 1}
    assert call_as(admin, "post", f"{ITEMS}assign/?kind=moon", many).status_code == 400


def test_shares_are_read_and_set(call_as, items, admin, annotator):
    read = call_as(admin, "get", SETTINGS)
    assert read.json()["unlabelled"] == 0
    assert call_as(admin, "patch", SETTINGS, {"unlabelled": 100}).status_code == 428
    saved = call_as(admin, "patch", SETTINGS, {"unlabelled": 100}, if_match=read["ETag"])
    assert saved.json()["unlabelled"] == 100
    assert {item.people for item in WorkItem.objects.all()} == {2}
    late = call_as(admin, "patch", SETTINGS, {"unlabelled": 0}, if_match=read["ETag"])
    assert (late.status_code, late.json()["current"]["unlabelled"]) == (412, 100)
    assert call_as(admin, "patch", SETTINGS, {"unlabelled": 101}, if_match="*").status_code == 400
    assert call_as(admin, "patch", SETTINGS, {"audit": 10}, if_match="*").status_code == 400


def test_reviewers_ask_for_a_look(call_as, tiny_world, reviewer, annotator):
    template = tiny_world.grammar.templates.first()
    sent = {"kind": "template", "id": template.pk, "reason": "Is this English?"}
    asked = call_as(reviewer, "post", ITEMS, sent)
    assert asked.status_code == 201
    assert asked.json()["subject"] == {"kind": "template", "id": template.pk}
    assert asked.json()["reason"] == "rene asks: Is this English?"
    assert call_as(reviewer, "post", ITEMS, sent).status_code == 409
    assert call_as(reviewer, "post", ITEMS, {**sent, "id": 10**6}).status_code == 404
    assert call_as(annotator, "post", ITEMS, sent).status_code == 403


def test_two_answers_are_compared(call_as, tiny_world, annotator, admin, reviewer):
    collect(tiny_world, ["bring me tea"], by=annotator)
    set_share(tiny_world, WorkKind.UNLABELLED, 100)
    refill(tiny_world)
    row = Utterance.objects.get()
    for person, form in ((annotator, "(go 1)"), (admin, "(go 2)")):
        sent = {"form": form, "version": row.version}
        call_as(person, "post", f"worlds/home/utterances/{row.pk}/label/", sent)
    item = WorkItem.objects.get(kind=WorkKind.ADJUDICATION)
    address = f"{ITEMS}{item.pk}/"
    assert call_as(reviewer, "get", address).json()["labels"] == []  # they may still be asked
    take(reviewer, item)
    labels = call_as(reviewer, "get", address).json()["labels"]
    assert [label["form"] for label in labels] == ["( go 1 )", "( go 2 )"]
    sent = {"verdict": "form", "form": "(go 3)", "version": row.version}
    call_as(reviewer, "post", f"{address}finish/", sent)
    row.refresh_from_db()
    assert row.logical_form == "( go 3 )"
