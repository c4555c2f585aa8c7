"""Labels of utterances, what words name, and what the checker says before anything is stored."""

from __future__ import annotations

import pytest

from annotations.generation.world_consequences import WorldConsequences
from annotations.labelling.collecting import collect
from annotations.language.templates.consequences import Consequences
from annotations.models import Entity, Predicate, SemanticTemplate, Utterance

HOME = "worlds/home/"


@pytest.fixture
def row(tiny_world, annotator) -> Utterance:
    collect(tiny_world, ["bring me the brew"], by=annotator)
    return Utterance.objects.get()


def test_an_utterance_is_labelled_and_the_answer_taken_back(call_as, row, annotator, admin):
    address = f"{HOME}utterances/{row.pk}/label/"
    late = {"form": "(go 1)", "version": row.version + 1}
    assert call_as(annotator, "post", address, late).status_code == 409
    wrong = call_as(annotator, "post", address, {"form": "(go", "version": row.version})
    assert wrong.json()["problems"][0]["field"] == "form"
    silent = {"verdict": "dispute", "version": row.version}
    assert call_as(annotator, "post", address, silent).status_code == 400
    made = call_as(annotator, "post", address, {"form": "(go 1)", "version": row.version})
    assert (made.status_code, made.json()["form"]) == (201, "( go 1 )")
    listed = call_as(annotator, "get", f"{HOME}labels/").json()["results"]
    assert [each["id"] for each in listed] == [made.json()["id"]]
    assert call_as(admin, "get", f"{HOME}labels/").json()["results"] == []
    back = f"{HOME}labels/{made.json()['id']}/take-back/"
    assert call_as(admin, "post", back).status_code == 409
    assert call_as(annotator, "post", back).json()["taken_back_at"]
    row.refresh_from_db()
    assert (row.status, row.logical_form) == ("unlabelled", "")


def test_words_are_said_to_name_an_entity(call_as, row, annotator):
    tea = Entity.objects.get(text="tea")
    start = row.text.index("brew")
    sent = {"start": start, "end": start + 4, "entity": tea.pk, "version": row.version}
    address = f"{HOME}utterances/{row.pk}/spans/"
    mended = call_as(annotator, "post", address, sent).json()
    assert mended["anonymized_text"] == "bring me the <object>"
    tea.refresh_from_db()
    assert tea.aliases == ["brew"]
    assert call_as(annotator, "post", address, sent).status_code == 409
    sent |= {"version": mended["version"], "end": start}
    assert call_as(annotator, "post", address, sent).status_code == 400
    assert call_as(annotator, "post", address, {**sent, "entity": 10**6}).status_code == 404


def test_a_template_is_checked_with_what_it_would_do(call_as, tiny_world, annotator):
    sent = {"task_category": "1", "pattern": "look at the {room}", "form": "(look {room})"}
    checked = call_as(annotator, "post", f"{HOME}check/template/", sent, scope="read").json()
    assert checked["commands"] == 1
    assert checked["samples"][0]["text"].startswith("look at the ")
    expected = checked["consequences"]
    assert expected["trouble"] == "" and expected["sentence"].startswith("1 ")
    broken = {**sent, "form": "(look {object"}
    checked = call_as(annotator, "post", f"{HOME}check/template/", broken).json()
    assert checked["problems"][0]["field"] == "form"
    assert checked["consequences"]["trouble"]
    row = SemanticTemplate.objects.get(pattern__startswith="go to")
    other = {**sent, "replaces": row.pk, "status": "draft"}
    checked = call_as(annotator, "post", f"{HOME}check/template/", other).json()
    one_lost = WorldConsequences(Consequences(lost=(None,)))
    assert checked["consequences"] == {"sentence": one_lost.sentence, "trouble": ""}
    missing = {**sent, "replaces": 10**6}
    assert call_as(annotator, "post", f"{HOME}check/template/", missing).status_code == 404
    assert SemanticTemplate.objects.count() == 2


def test_a_production_is_checked(call_as, tiny_world, annotator):
    sent = {"nonterminal": "vbfind", "expansion": "seek", "source": "common_rules.txt"}
    checked = call_as(annotator, "post", f"{HOME}check/production/", sent).json()
    assert (checked["problems"], checked["samples"]) == ([], ["seek"])
    assert [each["task_category"] for each in checked["sizes"]] == ["1"]
    broken = {**sent, "expansion": "seek ("}
    checked = call_as(annotator, "post", f"{HOME}check/production/", broken).json()
    assert (checked["problems"][0]["field"], checked["consequences"]) == ("expansion", None)
    elsewhere = {**sent, "source": "moon.txt"}
    refused = call_as(annotator, "post", f"{HOME}check/production/", elsewhere)
    assert refused.json()["problems"][0]["field"] == "source"


def test_a_predicate_is_checked(call_as, tiny_world, annotator):
    row = Predicate.objects.get(name="go")
    sent = {"name": "go", "kind": "action", "signatures": [["object", "object"]]}
    sent["replaces"] = row.pk
    checked = call_as(annotator, "post", f"{HOME}check/predicate/", sent).json()
    assert [each["pattern"] for each in checked["templates"]] == ["go to the {room}"]
    assert checked["samples"][0]["english"]
    wrong = {**sent, "signatures": [["moon"]]}
    assert call_as(annotator, "post", f"{HOME}check/predicate/", wrong).status_code == 400


def test_a_form_is_checked_as_the_label_of_an_utterance(call_as, tiny_world, reviewer):
    sent = {"form": '(go "<room>")', "utterance": "go to the kitchen"}
    checked = call_as(reviewer, "post", f"{HOME}check/form/", sent, scope="read").json()
    assert (checked["problems"], bool(checked["english"])) == ([], True)
    other = {**sent, "utterance": "go away"}
    checked = call_as(reviewer, "post", f"{HOME}check/form/", other).json()
    assert "room" in checked["problems"][0]["message"]
