"""What a robot does with the answers of a world that has templates and no run, by the Python client."""

from __future__ import annotations

import json

import jsonschema
import pytest
from command_desk import CommandDesk
from pytest_django.live_server_helper import LiveServer

from annotations.language.plans import joint_plan_schema, task_plan_schema
from annotations.models import ApiToken
from gpsr_client import Workbench
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import Shelf
from tests.annotations.conftest import household  # noqa: F401  a fixture
from tests.clients.conftest import parse_server  # noqa: F401

TWO = "walk to the hallway. After that, get me the tumbler"


@pytest.fixture
def shelf(household) -> Shelf:  # noqa: F811
    made = Shelf(10_000_000, Metrics())
    made.update()
    made.find("home", None, 0)  # a thread of the server does not see what a test has written
    return made


@pytest.fixture
def home(parse_server, live_server: LiveServer, annotator) -> Workbench:  # noqa: F811
    _, token = ApiToken.issue(annotator, "robot", scope="annotate")
    return Workbench(live_server.url, "home", token)


def test_what_the_world_answers_is_typed_and_acted_on(home):
    """One test, since the world takes seconds to make."""
    ask(home)
    act(home)


def ask(home):
    parse = home.parse("uhm, get me the, the tumbler")
    assert (parse.may_act, parse.parser, parse.run) == (True, "grammar-oracle", None)
    assert [(each.kind, each.heard) for each in parse.heard] == [("filler", ""), ("repeated", "")]
    assert all(parse.utterance[each.start : each.end] == each.said for each in parse.heard)
    assert parse.probability > 0.9 and parse.best.task_plan.is_executable

    lost = home.parse("bring me the flurb")
    assert (lost.decision, lost.probability, lost.best) == ("refuse", None, None)
    assert [each.code for each in lost.reasons] == ["unknown_word"]
    assert "flurb" in lost.spoken and home.parse(lost.nearest[0]).may_act

    both = home.parse(TWO)
    assert [each.utterance for each in both.several] == [
        "walk to the hallway",
        "get me the tumbler",
    ]
    assert all(each.may_act and each.joint_plan is None for each in both.several)
    assert both.may_act and both.joint_plan.plan.is_executable
    assert both.joint_plan.spoken == both.spoken
    assert {number for serves in both.joint_plan.serves for number in serves} == {1, 2}

    heard = [("walk to the chicken", -0.1), ("walk to the kitchen", -0.9)]
    assert home.parse(alternatives=heard).utterance == "walk to the kitchen"
    said = ["get me the tumbler", "sing"]
    parses = list(home.parse_many(said, parser="grammar-oracle"))
    assert [each.decision for each in parses] == ["act", "refuse"]
    assert home.parse(said[0], parser="grammar-oracle").raw == parses[0].raw


def act(home):
    said: list[str] = []
    plans: list[str] = []
    desk = CommandDesk(home, said.append, plans.append)
    desk.hear("get me the tumbler")
    jsonschema.validate(json.loads(plans[-1]), task_plan_schema())
    desk.hear(TWO)
    jsonschema.validate(json.loads(plans[-1]), joint_plan_schema())
    assert len(plans) == len(said) == 2
    desk.hear("Do not get me the tumbler")
    desk.hear("bring me the flurb")
    assert len(plans) == 2 and "flurb" in said[-1]
    desk.hear("walk to the hallway. Then sing a song")
    desk.hear("go there")
    assert said[-1].endswith("?")
    desk.hear("the hallway")
    desk.hear("yes")
    assert json.loads(plans[-1])["steps"][-1]["primitive"] == "go_to"
