"""Behaviour trees in BehaviorTree.CPP itself, where its binding ``behaviortreepy`` (PyPI) is installed.

The binding registers actions without ports, which the library then refuses in XML. So each tree is done twice: its
actions without their ports, and each action as a subtree, to which the library hands the same ports.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree import ElementTree

import pytest

from annotations.language.forms import read_form
from annotations.language.plans import (
    TAKEN_NAMES,
    Robust,
    apply_recipes,
    join,
    make_plan,
    read_book,
    shipped_books,
    to_behavior_tree,
)
from annotations.language.plans.behavior_tree import Steps
from tests.annotations.language.plans.test_task_plans import WORLDS, plans_of
from tests.annotations.language.sample_ontology import HOME

bt = pytest.importorskip("behaviortreepy", reason="needs the package behaviortreepy")

STEPS = "BehaviorTree/Sequence/Action"
ANSWER = "what the robot has learnt"
OF_OLDER = frozenset(  # in versions before or after the binding's, or names of another kind
    (
        *("SequenceStar", "TryCatch", "ManualSelector", "RetryUntilSuccesful", "ConsumeQueue"),
        *("BlackboardCheckInt", "BlackboardCheckDouble", "BlackboardCheckString"),
        *("BlackboardCheckBool", "TestNode", "SubTreePlus", "root", "Root", "BehaviorTree"),
        *("TreeNodesModel", "include", "MetadataFields", "Action", "Condition", "Control"),
        *("Decorator", "input_port", "output_port", "inout_port", "Command"),
    )
)


def do(xml: str, actions: set[str], ports: set[str]) -> list[tuple[str, dict[str, str]]]:
    """Run a tree whose actions succeed; return the name of each step, and its ports as the library reads them."""
    done: list[tuple[str, dict[str, str]]] = []

    def read(board, port: str) -> Iterator[tuple[str, str]]:
        try:
            yield port, board.get_string(port)
        except RuntimeError:
            return

    def tick(node) -> object:
        board = node.config().blackboard
        values = dict(each for port in ports for each in read(board, port))
        done.append((node.full_path().partition("/")[0], values))
        return bt.NodeStatus.SUCCESS

    factory = bt.BehaviorTreeFactory()
    for name in sorted(actions):
        factory.register_simple_action(name, tick)
    assert factory.create_tree_from_text(xml).tick_while_running() == bt.NodeStatus.SUCCESS
    return done


def require_done(plan: Steps) -> None:
    """Let the library do a plan: all steps in order, with the values of their ports."""
    xml = to_behavior_tree(plan)
    steps = ElementTree.fromstring(xml).findall(STEPS)
    written = [
        (
            step.get("name"),
            {
                port: ANSWER if value.startswith("{result_") else value
                for port, value in step.attrib.items()
                if port not in ("ID", "name", "result")
            },
        )
        for step in steps
    ]
    assert len(written) == len(plan.steps)
    ports = {port for _, values in written for port in values}
    assert do(as_subtrees(xml), {"Done"}, ports) == written

    actions = {step.attrib["ID"] for step in steps}
    assert do(without_ports(xml), actions, set()) == [(name, {}) for name, _ in written]


def without_ports(xml: str) -> str:
    root = ElementTree.fromstring(xml)
    for step in root.findall(STEPS):
        for port in step.attrib.keys() - {"ID", "name"}:
            del step.attrib[port]
    return ElementTree.tostring(root, encoding="unicode")


def as_subtrees(xml: str) -> str:
    root = ElementTree.fromstring(xml)
    for step in root.findall(STEPS):
        step.tag = "SubTree"
    for model in root.findall("TreeNodesModel/Action"):
        tree = ElementTree.SubElement(root, "BehaviorTree", {"ID": model.attrib["ID"]})
        inner = ElementTree.SubElement(tree, "Sequence")
        ElementTree.SubElement(inner, "Action", {"ID": "Done"})
        if model.find("output_port") is not None:
            learnt = {"value": ANSWER, "output_key": "result"}
            ElementTree.SubElement(inner, "SetBlackboard", learnt)
    return ElementTree.tostring(root, encoding="unicode")


@pytest.mark.parametrize("book", shipped_books())
@pytest.mark.parametrize("world", WORLDS)
def test_the_library_does_the_plans_of_every_world(world, book):
    if not WORLDS[world].is_dir():
        pytest.skip(f"there is no {WORLDS[world]}")
    own = shipped_books()[book].book
    plans = [plan for _, plan in plans_of(world)][::5]
    tasks = [apply_recipes(plan, own) for plan in plans]
    for plan, task in zip(plans, tasks, strict=True):
        require_done(plan)
        require_done(task)
    for at in range(0, len(tasks) - 2, 3):
        require_done(join(tasks[at : at + 3], own).plan)


@pytest.mark.parametrize("name", sorted(TAKEN_NAMES))
def test_an_action_that_has_the_name_of_a_node_is_done(name):
    """An action without a recipe keeps its name, whatever that is."""
    empty, _ = read_book("", "")
    require_done(apply_recipes(make_plan(read_form(f'({name} "attic")'), HOME), empty))


def test_every_node_of_the_library_is_known_to_be_taken():
    factory = bt.BehaviorTreeFactory()
    for name in sorted(TAKEN_NAMES - OF_OLDER):
        with pytest.raises(RuntimeError, match="already registered"):
            factory.register_simple_action(name, lambda node: bt.NodeStatus.SUCCESS)


def test_the_library_tries_a_step_again_and_hands_on_what_fails():
    book = shipped_books()["primitives"].book
    plan = apply_recipes(make_plan(read_form('(find (λ$1:e (is_a $1 "tea")) "attic")'), HOME), book)
    root = ElementTree.fromstring(to_behavior_tree(plan, Robust(3, 5.0)))
    for action in root.iter("Action"):
        for port in action.attrib.keys() - {"ID", "name"}:
            del action.attrib[port]
    done: list[str] = []

    def tick(name: str, succeeds_at: int):
        def act(node) -> object:
            done.append(name)
            is_done = done.count(name) >= succeeds_at
            return bt.NodeStatus.SUCCESS if is_done else bt.NodeStatus.FAILURE

        return act

    factory = bt.BehaviorTreeFactory()
    for name, succeeds_at in (("go_to", 2), ("find_object", 9), ("step_failed", 1)):
        factory.register_simple_action(name, tick(name, succeeds_at))
    tree = factory.create_tree_from_text(ElementTree.tostring(root, encoding="unicode"))
    assert tree.tick_while_running() == bt.NodeStatus.SUCCESS
    assert done == ["go_to"] * 2 + ["find_object"] * 3 + ["step_failed"]
