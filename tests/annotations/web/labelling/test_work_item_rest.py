"""/api/v1/worlds/<w>/work-items/"""

from __future__ import annotations

import pytest

from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import WantedItem, enqueue, refill, set_share
from annotations.labelling.giving import next_item
from annotations.labelling.item_answers import answer
from annotations.models import WorkKind
from annotations.models.worlds import Role
from tests.conftest import member

ALL = "worlds/home/work-items/"


@pytest.fixture
def queue(tiny_world, annotator):
    collect(tiny_world, ["bring me tea", "go to the kitchen"], by=annotator)
    refill(tiny_world)
    return tiny_world.work_items.order_by("pk")


@pytest.fixture
def call(call_as, annotator):
    return lambda method, path="", **data: call_as(annotator, method, ALL + path, data or None)


def test_the_rows_are_those_of_the_pages(call, queue, anna):
    answer = call("get").json()
    listed = anna.get("/w/home/queue/?sort=created").context["listing"].rows
    assert [row["id"] for row in answer["results"]] == [row.pk for row in listed]
    assert answer["results"][0]["reason"] == listed[0].reason != ""


def test_the_list_is_filtered(call, queue):
    call("post", "next/")
    taken = call("get", "?state=taken").json()["results"]
    assert [row["assignments"][0]["person"] for row in taken] == ["anna"]
    assert len(call("get", "?state=free&kind=unlabelled").json()["results"]) == 1
    assert call("get", "?state=done").json()["results"] == []
    assert call("get", "?state=late").status_code == 400


def test_an_item_is_labelled(call, queue):
    item = call("post", "next/").json()
    path = f"{item['id']}/finish/"
    version = item["subject"]["version"]
    assert call("post", path, form="(go", version=version).status_code == 400
    assert call("post", path, form="(go 1)", version=version + 5).status_code == 409
    answer = call("post", path, form='(go "<room>")', version=version)
    assert answer.json()["closed_at"]
    assert call("post", path, form='(go "<room>")').status_code == 409
    assert queue.get(pk=item["id"]).utterance.logical_form == '( go " <room> " )'


def test_an_item_is_given_back(call, queue):
    item = call("post", "next/").json()["id"]
    assert call("post", f"{item}/give-back/").json()["places"] == 1
    assert call("post", f"{item}/give-back/").status_code == 409


def test_what_is_no_utterance_needs_no_answer(call, queue, tiny_world):
    template = tiny_world.grammar.templates.first()
    enqueue(tiny_world, WorkKind.AUDIT, [WantedItem(template, "Look at it.")])
    item = call("post", "next/").json()
    assert item["subject"] == {"kind": "template", "id": template.pk}
    assert call("post", f"{item['id']}/finish/").json()["closed_at"]


def test_an_empty_queue(call, tiny_world):
    assert call("post", "next/").status_code == 204


@pytest.fixture
def for_two(tiny_world, queue, annotator):
    """The first item, which two people do and anna has answered by its own route."""
    set_share(tiny_world, WorkKind.UNLABELLED, 100)
    part = next_item(annotator, tiny_world)
    answer(part.item.utterance, "unknown", "", annotator, 1)
    return part.item


def test_one_person_is_one_party_on_every_route(call_as, tiny_world, annotator, admin, for_two):
    utterance, said = for_two.utterance, []
    berta = member(tiny_world, "berta", Role.ANNOTATOR)
    label = f"worlds/home/utterances/{utterance.pk}/label/"
    sent = {"form": "(go 1)", "version": 1}
    again = call_as(annotator, "post", label, sent)
    assert (again.status_code, again.json()["accepted_at"]) == (201, None)
    assert call_as(annotator, "post", label, sent).json()["id"] == again.json()["id"]
    finish = f"{ALL}{for_two.pk}/finish/"
    assert call_as(annotator, "post", finish, sent).status_code == 409
    assert call_as(annotator, "post", f"{ALL}{for_two.pk}/take/").status_code == 409
    assert call_as(berta, "post", f"{ALL}{for_two.pk}/take/").status_code == 200
    assert call_as(admin, "post", label, sent).status_code == 409  # two others are asked
    assert call_as(berta, "post", finish, {"verdict": "unknown"}).status_code == 200
    for person in (annotator, berta):
        said.append(call_as(person, "post", label, {"form": "(go 2)", "version": 1}).status_code)
        settling = tiny_world.work_items.get(kind=WorkKind.ADJUDICATION)
        said.append(call_as(person, "post", f"{ALL}{settling.pk}/take/").status_code)
    assert said == [409] * 4
    utterance.refresh_from_db()
    assert (utterance.status, utterance.version) == ("unlabelled", 1)
    assert call_as(admin, "post", f"{ALL}{settling.pk}/take/").status_code == 200
    finish = f"{ALL}{settling.pk}/finish/"
    assert call_as(admin, "post", finish, {"form": "(go 3)"}).status_code == 428
    assert call_as(admin, "post", finish, sent).status_code == 200
    utterance.refresh_from_db()
    assert utterance.logical_form == "( go 1 )"


def test_one_person_is_one_party_on_the_pages(anna, for_two, annotator, tiny_world):
    utterance = for_two.utterance
    address = f"/w/home/label/{utterance.pk}/answer/"
    for form in ("(go 1)", "(go 2)"):
        assert anna.post(address, {"form": form, "version": 1}).status_code == 302
    assert utterance.labels.valid().get().form == "( go 2 )"
    berta = member(tiny_world, "berta", Role.ANNOTATOR)
    answer(utterance, "unknown", "", berta, 1)
    refused = anna.post(
        address, {"form": "(go 3)", "version": 1}, headers={"accept": "application/json"}
    )
    assert refused.status_code == 409
    settling = tiny_world.work_items.get(kind=WorkKind.ADJUDICATION)
    anna.post(f"/w/home/queue/{settling.pk}/act/", {"step": "take"})
    anna.post(f"/w/home/queue/{settling.pk}/settle/", {"choice": "unknown"})
    utterance.refresh_from_db()
    assert (utterance.status, settling.assignments.count()) == ("unlabelled", 0)
