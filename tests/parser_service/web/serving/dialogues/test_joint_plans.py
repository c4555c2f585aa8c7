"""One plan of several commands: over the API, on its page, and how one utterance is taken apart."""

from __future__ import annotations

import jsonschema
import pytest

from annotations.language.plans import TooManyCommands, joint_plan_schema
from annotations.models import World
from parser_service.runs.promoting import promote
from parser_service.serving.joint_answers import commands_in
from tests.parser_service.served import trained_run

API, PAGE, JSON = "/api/v1/worlds/home/joint-plan/", "/w/home/parse/together/", "application/json"
TWO = ["go get the red cup in the kitchen", "bring me the bowl in the kitchen"]


@pytest.fixture
def browse(parse_server, client, annotator):
    client.force_login(annotator)
    return client


@pytest.mark.parametrize(
    ("utterance", "commands"),
    [
        (
            "Go to the kitchen. Then find the bowl; wave.",
            ("Go to the kitchen", "Then find the bowl", "wave"),
        ),
        ("go to the kitchen\nfind the bowl", ("go to the kitchen", "find the bowl")),
        ("bring me the 7.5 cm bowl", ("bring me the 7.5 cm bowl",)),
        (" . ", ()),
        ("...;;; !!!", ()),
        (
            "1. Go to the kitchen. 2. find the bowl 3. wave",
            ("Go to the kitchen", "find the bowl", "wave"),
        ),
        ("(1) go to the kitchen (2) wave", ("go to the kitchen", "wave")),
        ("go to the kitchen 2. wave", ("go to the kitchen 2", "wave")),
    ],
)
def test_sentences_are_commands(browse, utterance, commands):
    assert commands_in(World.objects.get(name="home"), utterance) == commands


def test_more_than_three_are_refused(browse):
    with pytest.raises(TooManyCommands):
        commands_in(World.objects.get(name="home"), "go. go. go. go")
    answer = browse.post(API, {"utterance": "go. go. go. go"}, JSON)
    assert answer.status_code == 400


def test_two_commands_become_one_plan(browse):
    answer = browse.post(API, {"utterances": TWO}, JSON).json()
    jsonschema.validate(answer["joint_plan"], joint_plan_schema())
    assert [each["utterance"] for each in answer["commands"]] == TWO
    served = {number for step in answer["joint_plan"]["steps"] for number in step["commands"]}
    assert served == {1, 2}
    assert answer["joint_plan"]["length"] <= answer["joint_plan"]["length_before"]
    together = browse.post(API, {"utterance": ". ".join(TWO)}, JSON).json()
    assert together["joint_plan"] == answer["joint_plan"]


def test_one_sentence_is_cut_by_what_the_parser_understands(browse, parse_server, world):
    promote(trained_run(world.splits.get(), config={"least_overlap": 0.4}), None)
    parse_server.update()
    said = {"utterance": "find the red cup and then bring me the bowl"}
    answer = browse.post(API, said, JSON).json()
    commands = [each["utterance"] for each in answer["commands"]]
    assert commands == ["find the red cup", "bring me the bowl"]


def test_a_table_of_distances_is_used(browse):
    far = {"one": "kitchen", "other": "operator", "distance": 40.5}
    answer = browse.post(API, {"utterances": TWO, "distances": [far]}, JSON).json()
    assert answer["joint_plan"]["length"] == 162  # twice there and back
    assert (answer["joint_plan"]["length_before"], answer["joint_plan"]["unit"]) == (162, "m")
    in_feet = browse.post(API, {"utterances": TWO, "distances": [far], "unit": "ft"}, JSON).json()
    assert in_feet["joint_plan"]["unit"] == "ft"


@pytest.mark.parametrize(
    "sent",
    [
        {"utterances": TWO, "utterance": TWO[0]},
        {
            "utterances": TWO,
            "distances": [
                {"one": "kitchen", "other": "operator", "distance": 1},
                {"one": "operator", "other": "kitchen", "distance": 2},
            ],
        },
    ],
)
def test_what_contradicts_itself_is_refused(browse, sent):
    answer = browse.post(API, sent, JSON)
    assert answer.status_code == 400 and answer.json()["detail"]


def test_a_joint_plan_is_a_behaviour_tree_too(browse):
    tree = browse.post(API, {"utterances": TWO, "as": "xml"}, JSON)
    assert b'ID="go_to"' in tree.content and b'ID="find_object"' in tree.content
    assert b'thing="bowl"' in tree.content and b"Fallback" not in tree.content
    sent = {"utterances": TWO, "as": "xml", "robust": True, "tries": 4, "seconds": 1.5}
    robust = browse.post(API, sent, JSON).content
    assert robust.count(b'num_attempts="4"') == robust.count(b'msec="1500"') > 0
    assert b'ID="step_failed"' in robust
    assert browse.post(API, {**sent, "tries": 0}, JSON).status_code == 400


def test_what_is_not_understood_is_said(browse, parse_server, world):
    promote(trained_run(world.splits.get(), config={"least_overlap": 0.1}), None)
    parse_server.update()
    answer = browse.post(API, {"utterances": [TWO[0], "xyzzy"]}, JSON).json()
    assert [each["is_unknown"] for each in answer["commands"]] == [False, True]
    note = answer["joint_plan"]["notes"][0]
    assert (note["code"], note["commands"]) == ("not_understood", [2]) and "xyzzy" in note[
        "message"
    ]
    assert answer["spoken"].startswith(note["message"])
    served = {number for step in answer["joint_plan"]["steps"] for number in step["commands"]}
    assert served == {1}
    assert browse.post(API, {}, JSON).status_code == 400


def test_the_page_shows_which_command_a_step_serves(browse):
    page = browse.post(f"{PAGE}ask/", {"command1": TWO[0], "command3": TWO[1]})
    text = page.content.decode()
    assert 'data-command="1"' in text and 'data-command="2"' in text
    assert all(f'data-note="{code}"' in text for code in ("way_back", "walk"))
    assert " rooms, with the way back; " in text
    assert page["HX-Replace-Url"].startswith(f"{PAGE}?command1=")
    assert browse.get(f"{PAGE}?command1=go").context["has_text"]
    assert browse.post(f"{PAGE}ask/", {"command1": "go. go. go. go"}).context["refused"]
