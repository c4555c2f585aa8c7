"""The chat, the words that come out of it, and the names of actions."""

from __future__ import annotations

import json

import pytest

from annotations.models import AuditEntry, Entity, Utterance
from parser_service.models import ActionNames, Dialogue, OfferedEntity
from parser_service.serving.parser_client import AWAY
from parser_service.serving.preparing import WorldLanguage
from tests.notices import levels
from tests.parser_service.served import make_home

PAGE, OFFERED, ROBOT = "/w/home/dialogue/", "/w/home/ontology/offered/", "/w/home/predicates/robot/"


@pytest.fixture
def browse(client, annotator):
    client.force_login(annotator)
    return client


def text_of(answer):
    return answer.content.decode()


def test_a_command_is_talked_about_learnt_and_kept(parse_server, browse):
    page = browse.post(PAGE, {"utterance": "bring me the flurb"}, follow=True)
    assert "Which object do you mean by “flurb”?" in text_of(page)
    row = Dialogue.objects.get()
    assert '<option value="red cup">' in text_of(page) and not page.context["plan"]["is_executable"]
    address = f"{PAGE}{row.pk}/"
    page = browse.post(address, {"answer": "new", "version": 1}, follow=True)
    assert "Shall I bring you the flurb?" in text_of(page)
    assert [each.text for each in page.context["offers"]] == ["flurb"]
    page = browse.post(address, {"answer": "yes", "version": 2}, follow=True)
    assert f'action="{address}keep/"' in text_of(page)
    assert f'href="{OFFERED}"' in text_of(browse.get(PAGE))
    kept = browse.post(f"{address}keep/", follow=True)
    assert levels(kept) == ["success"]
    assert Utterance.objects.get().origin == "dialogue"
    said = AuditEntry.objects.order_by("pk").values_list("what", "subject")
    assert list(said[:2]) == [
        ("begin a dialogue", "bring me the flurb"),
        ("answer in a dialogue", "bring me the flurb"),
    ]


def test_an_answer_to_an_older_question_changes_nothing(parse_server, browse):
    browse.post(PAGE, {"utterance": "bring me the flurb"})
    address = f"{PAGE}{Dialogue.objects.get().pk}/"
    browse.post(address, {"answer": "bowl", "version": 1})
    late = browse.post(address, {"answer": "red cup", "version": 1})
    assert late.status_code == 422
    assert late.context["trouble"] in text_of(late)
    assert "Shall I bring you the bowl?" in text_of(late)


def test_a_dialogue_is_stopped_by_a_button(parse_server, browse):
    browse.post(PAGE, {"utterance": "bring me the flurb"})
    address = f"{PAGE}{Dialogue.objects.get().pk}/"
    page = browse.post(address, {"answer": "", "stop": "1", "version": 1}, follow=True)
    row = page.context["row"]
    assert row.is_over and row.phase != "done"
    assert row.transcript[-1]["text"] in text_of(page)
    assert f'class="primary" href="{PAGE}"' in text_of(page)


def test_without_a_parse_server_the_page_says_so_and_keeps_the_text(world, browse):
    answer = browse.post(PAGE, {"utterance": "bring me the flurb"})
    assert answer.status_code == 422
    assert AWAY in text_of(answer)
    assert 'value="bring me the flurb"' in text_of(answer)


def test_annotators_decide_about_words_from_dialogues(world, browse):
    make_home(world)
    rows = [
        OfferedEntity.objects.create(
            world=world, entity_class="object", text=text, said_in=f"bring me the {text}"
        )
        for text in ("flurb", "glim")
    ]
    assert "bring me the glim" in text_of(browse.get(OFFERED))
    browse.post(f"{OFFERED}{rows[0].pk}/decide/", {"confirm": "1"})
    again = browse.post(f"{OFFERED}{rows[0].pk}/decide/", {"refuse": "1"}, follow=True)
    assert levels(again)[-1] == "error" and "flurb" in str(list(again.context["messages"])[-1])
    browse.post(f"{OFFERED}{rows[1].pk}/decide/", {"refuse": "1"})
    assert Entity.objects.filter(text="flurb").exists()
    assert not Entity.objects.filter(text="glim").exists()


def test_actions_get_the_names_of_the_robot(sample, browse):
    page = browse.get(ROBOT)
    assert 'name="name ask_operator"' in text_of(page) and 'name="name find"' in text_of(page)
    sent = {"version": 0, "name find": "Search", "arguments find": "target = thing"}
    assert browse.post(ROBOT, sent).status_code == 302
    names = WorldLanguage.of(sample.world).action_names
    assert (names["find"].name, dict(names["find"].arguments)) == ("Search", {"target": "thing"})
    late = browse.post(ROBOT, sent)
    assert late.status_code == 422 and 'role="alert"' in text_of(late)
    assert ActionNames.objects.get().version == 1


@pytest.mark.parametrize(
    ("name", "arguments", "named"),
    [
        ("no name", "", "“no name”"),
        ("id", "", "“id”"),
        ("Sequence", "", "“Sequence”"),
        ("root", "", "“root”"),
        ("", "goal", "“goal”"),
        ("", "a=x, b=x", "“b=x”"),
    ],
)
def test_what_no_robot_can_be_told_is_refused(sample, browse, name, arguments, named):
    answer = browse.post(ROBOT, {"name find": name, "arguments find": arguments, "version": 0})
    assert answer.status_code == 422 and named in text_of(answer)
    (row,) = [row for row in answer.context["rows"] if row.trouble]
    assert row.is_name_wrong == bool(name)
    assert text_of(answer).count('aria-invalid="true"') == 1
    assert not ActionNames.objects.exists()


def test_the_schemas_are_files(sample, browse):
    schema = browse.get(f"{ROBOT}plan.schema.json")
    assert json.loads(schema.content)["title"] == "Plan"
    assert schema["Content-Disposition"] == 'attachment; filename="plan.schema.json"'
    assert browse.get(f"{ROBOT}behavior_tree.xsd").content.startswith(b"<?xml")
    assert browse.get(f"{ROBOT}settings.py").status_code == 404
