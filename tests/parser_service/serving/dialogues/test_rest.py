"""Dialogues over REST."""

from __future__ import annotations

import jsonschema

from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import refill, set_share
from annotations.language.plans import plan_schema
from annotations.models import Entity, Label, Utterance, WorkItem, WorkKind, World
from parser_service.models import Dialogue, OfferedEntity
from parser_service.serving.conversation import AnsweredMeanwhile
from parser_service.serving.entity_offers import confirm

DIALOGUES = "/api/v1/worlds/home/dialogues/"


def test_an_unknown_word_is_asked_about_learnt_and_then_known(parse_server, call, annotator, world):
    begun = call(annotator, DIALOGUES, {"utterance": "bring me the flurb"})
    assert begun.status_code == 201
    first = begun.json()
    assert (
        first["prompt"]
        == "Which object do you mean by “flurb”? Red cup or bowl? Name one that I know, or say “new”."
    )
    assert first["asked"] == {
        "entity_class": "object",
        "choices": ["red cup", "bowl"],
        "likely": None,
        "phrases": ["flurb"],
    }
    jsonschema.validate(first["plan"], plan_schema())
    assert first["plan"]["steps"][0]["predicate"] == "ask_operator"

    address = f"{DIALOGUES}{first['id']}/"
    second = call(annotator, f"{address}answer/", {"answer": "new", "version": 1}).json()
    assert second["phase"] == "confirming"
    assert second["prompt"] == "Shall I bring you the flurb?"
    assert second["offers"] == [{"entity_class": "object", "text": "flurb", "alias": ""}]
    third = call(annotator, f"{address}answer/", {"answer": "yes"}).json()
    assert (third["phase"], third["is_over"]) == ("done", True)
    assert third == call(annotator, address).json()
    assert [turn["who"] for turn in third["transcript"]] == ["person", "robot"] * 3

    offered = OfferedEntity.objects.get()
    assert (offered.text, offered.said_in) == ("flurb", "bring me the flurb")
    confirm(offered, annotator)
    assert Entity.objects.filter(ontology__world=world, text="flurb").exists()
    parse_server.update()
    again = call(annotator, DIALOGUES, {"utterance": "bring me the flurb"}).json()
    assert (again["phase"], again["asked"]) == ("confirming", None)
    assert again["plan"]["is_executable"]


def test_an_utterance_can_be_said_another_way(parse_server, call, annotator):
    row = call(annotator, DIALOGUES, {"utterance": "find the bowl"}).json()
    address = f"{DIALOGUES}{row['id']}/answer/"
    assert call(annotator, address, {"answer": "no"}).json()["phase"] == "rephrasing"
    again = call(annotator, address, {"answer": "find the red cup"}).json()
    assert (again["utterance"], again["phase"]) == ("find the red cup", "confirming")
    assert "red cup" in again["grounded"]


def test_a_finished_dialogue_becomes_a_labelled_utterance(parse_server, call, annotator, reviewer):
    row = call(annotator, DIALOGUES, {"utterance": "find the bowl"}).json()
    address = f"{DIALOGUES}{row['id']}/"
    early = call(annotator, f"{address}keep/", {})
    assert early.status_code == 409 and early.json()["detail"]
    call(annotator, f"{address}answer/", {"answer": "yes"})
    assert call(reviewer, f"{address}keep/", {}).status_code == 403
    kept = call(annotator, f"{address}keep/", {}).json()
    utterance = Utterance.objects.get()
    assert kept["kept_as"] == utterance.pk
    assert (utterance.text, utterance.origin) == ("find the bowl", "dialogue")
    assert (utterance.status, utterance.logical_form) == ("labelled", row["form"])
    assert Label.objects.get().annotator == annotator
    assert call(annotator, f"{address}keep/", {}).json()["kept_as"] == utterance.pk
    assert Label.objects.count() == 1


def test_what_two_people_are_asked_about_is_not_settled_by_a_dialogue(
    parse_server, call, annotator
):
    world = World.objects.get()
    set_share(world, WorkKind.UNLABELLED, 100)
    collect(world, ["find the bowl"])
    refill(world)
    assert WorkItem.objects.open().for_two().exists()
    row = call(annotator, DIALOGUES, {"utterance": "find the bowl"}).json()
    call(annotator, f"{DIALOGUES}{row['id']}/answer/", {"answer": "yes"})
    assert call(annotator, f"{DIALOGUES}{row['id']}/keep/", {}).status_code == 200
    assert Label.objects.get().accepted_at is None
    assert Utterance.objects.get().status == "unlabelled"


def test_an_answer_to_an_older_state_is_refused(parse_server, call, annotator):
    row = call(annotator, DIALOGUES, {"utterance": "bring me the flurb"}).json()
    address = f"{DIALOGUES}{row['id']}/answer/"
    call(annotator, address, {"answer": "bowl", "version": 1})
    late = call(annotator, address, {"answer": "red cup", "version": 1})
    assert late.status_code == 409
    assert late.json()["detail"] == AnsweredMeanwhile().message
    assert "bowl" in call(annotator, f"{DIALOGUES}{row['id']}/").json()["grounded"]


def test_a_key_starts_one_dialogue(parse_server, call, annotator):
    said = {"utterance": "find the bowl"}
    first, second = (
        call(annotator, DIALOGUES, said, **{"idempotency-key": "once"}).json() for _ in range(2)
    )
    assert first == second and Dialogue.objects.count() == 1


def test_without_a_parse_server_it_says_so(world, call, annotator):
    answer = call(annotator, DIALOGUES, {"utterance": "find the bowl"})
    assert answer.status_code == 503
    assert Dialogue.objects.count() == 0


def test_a_token_to_read_starts_no_dialogue(parse_server, call, annotator):
    said = {"utterance": "find the bowl"}
    assert call(annotator, DIALOGUES, said, scope="read").status_code == 403
    assert call(annotator, DIALOGUES, said).status_code == 201
    assert call(annotator, DIALOGUES, scope="read").json()["results"][0]["phase"] == "confirming"
