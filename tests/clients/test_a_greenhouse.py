"""What a robot does with the answers of a greenhouse, where no recipe that ships covers an action."""

from __future__ import annotations

import jsonschema
import pytest
from pytest_django.live_server_helper import LiveServer

from annotations.editing.recipe_books import take_proposals
from annotations.language.plans import joint_plan_schema, task_plan_schema
from annotations.models import ApiToken, World
from gpsr_client import Workbench
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import Shelf
from tests.clients.conftest import parse_server  # noqa: F401
from tests.greenhouse import fill_greenhouse

THREE = ("water the basil in the last bed", "prune the tomato with the shears", "fetch me the hose")


@pytest.fixture
def shelf(world: World) -> Shelf:
    fill_greenhouse(world)
    made = Shelf(10_000_000, Metrics())
    made.update()
    made.find("home", None, 0)  # a thread of the server does not see what a test has written
    return made


@pytest.fixture
def robot(parse_server, live_server: LiveServer, annotator) -> Workbench:  # noqa: F811
    _, token = ApiToken.issue(annotator, "robot", scope="annotate")
    return Workbench(live_server.url, "home", token)


def test_a_robot_of_a_greenhouse_plans_before_its_recipes_and_acts_with_them(
    robot, shelf, world, annotator
):
    parse = robot.parse(THREE[0])
    plan = parse.best.task_plan
    (step,) = plan.steps
    assert step.is_proposed and step.primitive == "water" and step.place is None
    assert {name: each["text"] for name, each in step.arguments.items()} == {
        "plant": "basil",
        "bed": "last bed",
    }
    assert "basil" in parse.best.spoken and not plan.is_executable and not parse.may_act
    joint = robot.joint_plan(list(THREE))
    jsonschema.validate(joint.raw["joint_plan"], joint_plan_schema())
    assert [each.primitive for each in joint.plan.steps][:3] == ["water", "prune", "fetch"]

    take_proposals(world, annotator)
    shelf.update()
    parse = robot.parse(THREE[0])
    assert parse.best.task_plan.is_executable and not parse.best.task_plan.steps[0].is_proposed
    jsonschema.validate(parse.raw["candidates"][0]["task_plan"], task_plan_schema())
    assert 'ID="water"' in robot.behavior_tree(parse.best.grounded, in_primitives=True)
    (gap,) = robot.task_plan('( water " <plant> " )').unresolved[0].open
    assert gap.question == "Which plant shall I water?" and gap.entity_class == "plant"
    joint = robot.joint_plan(list(THREE))
    assert joint.plan.is_executable and "prune the tomato" in joint.spoken
