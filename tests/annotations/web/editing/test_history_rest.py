"""Rows that people edit: added, changed and deleted over the API as on the pages."""

from __future__ import annotations

import pytest

from annotations.editing.edits import change
from annotations.generation.generating import generate_pairs
from annotations.models import Entity, SemanticTemplate
from annotations.rows.history import history_of
from annotations.rows.row_kinds import KINDS
from annotations.web.editing.history_rest import SERIALIZERS, serializer_of
from tests.sample_world import make_paraphrase

HOME = "worlds/home/"
MILK = {"entity_class": "object", "text": "oat milk", "aliases": ["oat drink"]}
GO = {"task_category": "Category 1", "pattern": "go to the {room}", "form": "(go {room})"}
# What is sent of a new row, what is changed of it then, and what of the change is shown.
NOUNS = {
    "entities": (
        {**MILK, "attributes": {"category": "drinks"}},
        {"aliases": [], "attributes": {"category": "food", "room": ""}},
        {"aliases": [], "text": "oat milk", "attributes": {"category": "food", "room": ""}},
    ),
    "entity-classes": (
        {"token": "pose", "singular": "pose", "plural": "poses", "said": "pose", "hue": 20},
        {"said": "way to sit", "is_closed": True},
        {"said": "way to sit", "is_closed": True, "token": "pose", "hue": 20},
    ),
    "predicates": (
        {"name": "is_hot", "kind": "description", "signatures": [["variable"]]},
        {"signatures": [["variable", "object?"]], "gloss": "hot"},
        {"signatures": [["variable"], ["variable", "object"]], "gloss": "hot", "name": "is_hot"},
    ),
    "productions": (
        {"nonterminal": "vbfind", "expansion": "look  for", "source": "common_rules.txt"},
        {"expansion": "search"},
        {"expansion": "search", "nonterminal": "vbfind"},
    ),
    "templates": (
        {**GO, "pattern": "$vbfind the {room}", "status": "draft"},
        {"form": "(go {room} )"},
        {"form": "(go {room} )", "status": "draft", "pattern": "$vbfind the {room}"},
    ),
}


@pytest.fixture
def call(call_as, annotator):
    """A function: the answer to a request of the annotator, with JSON and headers."""
    return lambda method, path, data=None, **headers: call_as(
        annotator, method, HOME + path, data, **headers
    )


@pytest.fixture
def category(tiny_world):
    return tiny_world.grammar.task_categories.get().name


@pytest.mark.parametrize("noun", NOUNS)
def test_a_row_is_added_changed_and_deleted(noun, call, category, annotator):
    new, changes, shown = NOUNS[noun]
    if noun == "templates":
        new = {**new, "task_category": category}
    made = call("post", f"{noun}/", new)
    assert made.status_code == 201, made.json()
    path = f"{noun}/{made.json()['id']}/"
    assert made["Location"].endswith(path)
    read = call("get", path)
    assert read["ETag"] == made["ETag"] == '"1"'
    changed = call("patch", path, changes, if_match=read["ETag"])
    assert (changed.status_code, changed["ETag"]) == (200, '"2"'), changed.json()
    assert shown.items() <= call("get", path).json().items()
    stale = call("patch", path, changes, if_match='"1"')
    assert stale.status_code == 412
    assert stale.json()["current"] == call("get", path).json()
    assert call("delete", path, if_match='"1"').status_code == 412
    assert call("delete", path).status_code == 428
    assert call("delete", path, if_match='"2"').status_code == 204
    assert call("get", path).status_code == 404


def test_the_history_knows_who_and_the_commands_follow(call, category, tiny_world, annotator):
    row = SemanticTemplate.objects.get(pattern="go to the {room}")
    answer = call("patch", f"templates/{row.pk}/", {"status": "draft"}, if_match="*")
    assert answer.json()["status"] == "draft"
    assert history_of(SemanticTemplate).filter(id=row.pk).first().history_user == annotator
    assert not tiny_world.commands.filter(anonymized_text__startswith="go").exists()
    call("patch", f"templates/{row.pk}/", {"status": "ready"}, if_match="*")
    assert tiny_world.commands.filter(anonymized_text="go to the <room>").exists()


def test_problems_say_where_they_are(call, category):
    sent = {**GO, "task_category": category, "form": "(go\n{room}"}
    answer = call("post", "templates/", sent)
    assert answer["Content-Type"] == "application/problem+json"
    problem = answer.json()
    assert (problem["status"], problem["title"]) == (400, "Bad Request")
    (found,) = problem["problems"]
    assert (found["field"], found["line"], found["severity"]) == ("form", 2, "error")
    assert not SemanticTemplate.objects.filter(form__contains="\n").exists()


@pytest.mark.parametrize(
    ("noun", "sent", "field"),
    [
        ("entities", {**MILK, "txt": "x"}, "txt"),
        ("entities", {**MILK, "aliases": ["a\nb"]}, "aliases.0"),
        ("entities", {**MILK, "attributes": {"a: b": "c"}}, "attributes"),
        ("entities", {**MILK, "attributes": {"a\nb": "c"}}, "attributes"),
        ("entities", {**MILK, "text": "\ud800"}, "text"),
        ("predicates", {"name": "is hot", "kind": "action", "signatures": []}, "name"),
        ("predicates", {"name": "hot", "kind": "action", "signatures": [["moon"]]}, "signatures"),
        ("productions", {"nonterminal": "a", "expansion": "b", "source": "c.txt"}, "source"),
        ("templates", GO | {"task_category": "none"}, "task_category"),
    ],
)
def test_what_cannot_be_stored_is_refused_with_its_field(noun, sent, field, call, category):
    answer = call("post", f"{noun}/", sent)
    assert answer.status_code == 400
    assert field in {each.get("field") for each in answer.json()["problems"]}


@pytest.mark.parametrize(
    ("noun", "sent"),
    [
        ("entities", {**MILK, "text": "tea"}),
        ("predicates", {"name": "go", "kind": "action", "signatures": [["room"]]}),
    ],
)
def test_what_is_there_already_is_a_conflict(noun, sent, call, category):
    answer = call("post", f"{noun}/", sent)
    assert (answer.status_code, answer.json()["code"]) == (409, "is_there_already")


def test_the_same_key_makes_one_row(call, category):
    first = call("post", "entities/", MILK, idempotency_key="a")
    again = call("post", "entities/", MILK, idempotency_key="a")
    assert (again.status_code, again.json()) == (201, first.json())
    assert (again["Idempotency-Replayed"], again["ETag"]) == ("true", first["ETag"])
    other = {**MILK, "text": "soy milk"}
    assert call("post", "entities/", other, idempotency_key="a").status_code == 422
    assert call("post", "entities/", {}, idempotency_key="b").status_code == 400
    assert call("post", "entities/", other, idempotency_key="b").status_code == 201


def test_a_clash_within_the_request_shows_the_present_row(
    call, category, annotator, admin, monkeypatch
):
    row = Entity.objects.get(text="tea")

    def too_late(*args, **options):
        change(row, {"aliases": ["chai"]}, admin, row.version)
        return change(*args, **options)

    monkeypatch.setattr("annotations.web.editing.noun_rest.change", too_late)
    answer = call("patch", f"entities/{row.pk}/", {"aliases": ["char"]}, if_match='"1"')
    assert (answer.status_code, answer.json()["current"]["aliases"]) == (412, ["chai"])


def test_a_paraphrase_is_relabelled_and_deleted(call, sample, reviewer, client):
    row = make_paraphrase(sample.world, grounded_form="( go )", logical_form="( go )")
    path = f"paraphrases/{row.pk}/"
    answer = call("patch", path, {"logical_form": '(go "<room>")'}, if_match='"1"')
    assert answer.json()["logical_form"] == '( go " <room> " )', answer.json()
    assert call("patch", path, {"logical_form": "(go"}, if_match='"2"').status_code == 400
    assert call("delete", path, if_match='"2"').status_code == 204


def test_a_split_is_frozen_and_renewed(call, category, tiny_world):
    generate_pairs(tiny_world)
    sent = {"name": "first", "proportions": [0.5, 0.25, 0.25], "seed": 3}
    made = call("post", "splits/", sent, idempotency_key="k")
    assert made.status_code == 201, made.json()
    assert sum(made.json()["counts"][0][part] for part in ("train", "validation", "test")) > 0
    path = f"splits/{made.json()['id']}/"
    assert call("get", path).json()["content_hash"] == made.json()["content_hash"]
    assert call("post", f"{path}renew/").status_code == 400
    row = SemanticTemplate.objects.get(pattern="go to the {room}")
    call("patch", f"templates/{row.pk}/", {"status": "draft"}, if_match="*")
    renewed = call("post", f"{path}renew/")
    assert renewed.json()["follows"] == made.json()["id"]
    refused = call("post", "splits/", {**sent, "proportions": [0.5, 0.1, 0.1], "name": "x"})
    assert "100 %" in refused.json()["detail"]


def test_every_kind_of_row_has_a_serializer():
    assert SERIALIZERS.keys() == KINDS.keys()
    for kind in KINDS.values():
        assert serializer_of(kind).Meta.model is kind.model
