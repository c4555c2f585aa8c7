"""/api/v1/worlds/<w>/work-items/"""

from __future__ import annotations

import pytest

from annotations.labelling import collect
from annotations.models import WorkKind
from annotations.queueing import WantedItem, enqueue
from annotations.queueing.sources import refill

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
    assert answer["results"][0]["reason"] == "Nobody has said yet what this means."


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
