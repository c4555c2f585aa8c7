"""The ROS 2 node, with the message definitions of each ROS 2 release in place of an installation."""

from __future__ import annotations

import ast
import importlib
import json
import sys
from collections.abc import Callable
from types import ModuleType
from typing import Any

import jsonschema
import pytest
from pytest_django.live_server_helper import LiveServer

from annotations.language.plans import task_plan_schema
from annotations.models import ApiToken
from tests.clients.conftest import CLIENT
from tests.waiting import wait_for

typesys = pytest.importorskip("rosbags.typesys", reason="needs the package rosbags")

EXAMPLE = CLIENT / "examples" / "ros2_command_node.py"
RELEASES = [each for each in typesys.Stores if each.name.startswith("ROS2")]
Heard = Callable[[Any], None]


class Publisher:
    """Sends a message as the middleware does: in its wire format, by its definition."""

    def __init__(self, store: Any, kind: type) -> None:
        self.kind, self.sent = kind, list[Any]()
        self._store = store

    def publish(self, message: Any) -> None:
        assert isinstance(message, self.kind)
        name = message.__msgtype__
        self.sent.append(
            self._store.deserialize_cdr(self._store.serialize_cdr(message, name), name)
        )


class Node:
    """What the example needs of ``rclpy.node.Node``."""

    store: Any

    def __init__(self, name: str) -> None:
        self.name = name
        self.publishers: dict[str, Publisher] = {}
        self.subscriptions: dict[str, tuple[type, Heard]] = {}

    def declare_parameter(self, name: str, value: str) -> Any:
        return type("Parameter", (), {"value": PARAMETERS[name]})

    def create_publisher(self, kind: type, topic: str, depth: int) -> Publisher:
        self.publishers[topic] = Publisher(self.store, kind)
        return self.publishers[topic]

    def create_subscription(self, kind: type, topic: str, callback: Heard, depth: int) -> None:
        self.subscriptions[topic] = kind, callback


PARAMETERS: dict[str, str] = {}


def messages() -> dict[str, set[str]]:
    """Return the messages that the example imports, with the fields that it sets: ``std_msgs/msg/String``."""
    tree = ast.parse(EXAMPLE.read_text(encoding="utf-8"))
    used: dict[str, set[str]] = {}
    names: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").endswith("_msgs.msg"):
            for each in node.names:
                names[each.name] = f"{str(node.module).replace('.', '/')}/{each.name}"
                used[names[each.name]] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in names:
            assert not node.args, "ROS messages take their fields by name"
            used[names[node.func.id]] |= {str(each.arg) for each in node.keywords}
    return used


@pytest.mark.parametrize("release", RELEASES)
def test_its_messages_are_those_of_the_release(release):
    definitions = typesys.get_typestore(release).fielddefs
    used = messages()
    assert used
    for name, fields in used.items():
        assert fields and fields <= {field for field, _ in definitions[name][1]}


def test_it_publishes_the_plan_of_what_was_heard_and_agreed(
    parse_server, live_server: LiveServer, annotator, monkeypatch
):
    store = typesys.get_typestore(typesys.Stores.LATEST)
    String = store.types["std_msgs/msg/String"]
    stand_ins = {
        "rclpy": {},
        "rclpy.node": {"Node": Node},
        "rclpy.publisher": {"Publisher": Publisher},
        "std_msgs": {},
        "std_msgs.msg": {"String": String},
    }
    for name, values in stand_ins.items():
        module = ModuleType(name)
        vars(module).update(values)
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.delitem(sys.modules, "ros2_command_node", raising=False)
    monkeypatch.setattr(Node, "store", store, raising=False)
    _, token = ApiToken.issue(annotator, "robot", scope="annotate")
    monkeypatch.setenv("GPSR_TOKEN", token)
    monkeypatch.setitem(PARAMETERS, "url", live_server.url)
    monkeypatch.setitem(PARAMETERS, "world", "home")

    example = importlib.import_module("ros2_command_node")
    node = example.CommandNode()
    kind, hear = node.subscriptions["speech/text"]
    plans, said = (node.publishers[topic].sent for topic in ("command/plan", "speech/say"))
    for n, text in enumerate(("find the bowl", "yes"), start=1):
        hear(kind(data=text))
        wait_for(lambda n=n: len(said) == n, f"answer {n}")
    wait_for(lambda: plans, "a plan")
    (plan,) = (json.loads(each.data) for each in plans)
    jsonschema.validate(plan, task_plan_schema())
    assert [step["primitive"] for step in plan["steps"]] == ["find_object"]
