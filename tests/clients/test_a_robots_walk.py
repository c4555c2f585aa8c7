"""A robot's way with the Python client, from what people say to what it does, in the world of a competition."""

from __future__ import annotations

import json

import jsonschema
import pytest
from pytest_django.live_server_helper import LiveServer

from annotations.exchange.generator_import import import_generator
from annotations.exchange.pair_import import import_pairs
from annotations.exchange.shipped_worlds import PARAPHRASES, SHIPPED_WORLDS
from annotations.generation.freezing import freeze_split
from annotations.language.plans import joint_plan_schema, plan_schema, task_plan_schema
from annotations.models import ApiToken, World
from gpsr_client import Workbench
from parser_service.runs.promoting import promote
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import Shelf
from tests.clients.conftest import parse_server  # noqa: F401
from tests.parser_service.served import trained_run

FOLDER = SHIPPED_WORLDS["competition"].folder


@pytest.fixture
def world(world: World) -> World:
    """The world of a competition, with what people say there."""
    assert not import_generator(world.name, FOLDER).is_refused
    assert not import_pairs(world.name, PARAPHRASES, FOLDER).is_refused
    return world


@pytest.fixture
def shelf(world: World) -> Shelf:
    """What serves a nearest neighbour that has learned from the paraphrases alone."""
    split = freeze_split(world, "said")
    promote(trained_run(split, parser="knn", train_sources="para"), None)
    made = Shelf(100_000_000, Metrics())
    made.update()
    return made


@pytest.fixture
def robot(parse_server, live_server: LiveServer, annotator) -> Workbench:  # noqa: F811
    _, token = ApiToken.issue(annotator, "robot", scope="annotate")
    return Workbench(live_server.url, "home", token)


def test_what_people_say_is_asked_about_and_becomes_what_the_robot_does_and_says(
    robot, world, tmp_path
):
    """One test, since the world takes ten seconds to import."""
    ask_and_plan(robot)
    plan_together(robot)
    export(robot, world, tmp_path)


def ask_and_plan(robot):
    parse = robot.parse("could I have the toaster out of the galley, please?")
    (slot,) = parse.best.open_slots
    assert slot.entity_class == "object" and not parse.best.task_plan.is_executable

    talk = robot.dialogue("could I have the toaster out of the galley, please?")
    assert talk.asked is not None and talk.asked.entity_class == "object"
    talk = talk.answer("the pretzel")
    assert talk.asked is None and not talk.is_over
    talk = talk.answer("yes")

    assert talk.is_agreed and talk.task_plan.is_executable
    steps = talk.task_plan.steps
    assert [step.primitive for step in steps] == [
        *("go_to", "find_object", "pick_up", "go_to", "give"),
    ]
    assert steps[0].arguments["place"]["text"] == "galley"
    assert steps[-1].releases is not None and "pretzel" in steps[-1].text
    assert talk.spoken.startswith("I will") and "pretzel" in talk.spoken
    jsonschema.validate(talk.raw["task_plan"], task_plan_schema())
    jsonschema.validate(talk.raw["plan"], plan_schema())
    assert robot.task_plan(talk.grounded) == talk.task_plan
    assert robot.behavior_tree(talk.grounded, in_primitives=True).count("<Action ID=") == 9


def plan_together(robot):
    said = ["bring me the chess set", "pretzel from the galley, please"]
    joint = robot.joint_plan(said)
    jsonschema.validate(joint.raw["joint_plan"], joint_plan_schema())
    assert joint.plan.is_executable and joint.length <= joint.length_before
    assert {command for step in joint.serves for command in step} == {1, 2}
    assert "chess set" in joint.spoken and "pretzel" in joint.spoken


def export(robot, world, tmp_path):
    names = robot.export_vocabulary(tmp_path / "names.txt", only="names").read_text().splitlines()
    assert "pretzel" in names
    words = json.loads(robot.export_vocabulary(tmp_path / "vosk", format="vosk").read_text())
    assert {"pretzel", "[unk]"} <= set(words)
    lines = robot.export_rephrased(tmp_path / "tests", format="tests").read_text().splitlines()
    cases = [json.loads(line) for line in lines]
    assert len(cases) == world.paraphrases.count()
    for case in cases[::20]:
        jsonschema.validate(case["expected"], task_plan_schema())
    of_split = robot.export_rephrased(tmp_path / "part", "pairs", split="said", part="validation")
    assert 0 < len(of_split.read_text().splitlines()) < len(cases) / 5
