"""Write a plan as a behaviour tree of BehaviorTree.CPP, format 4.

https://www.behaviortree.dev/docs/learn-the-basics/xml_format; what is written here is valid against
``behavior_tree.xsd`` beside this module. Nodes are written explicitly (``<Action ID="go" …/>``).
Entities, texts, numbers and the operator are ports with plain text, and so is a description of which only the noun or
the name is said. Other descriptions are ports with ``json:`` and their JSON (the prefix that the library itself uses),
results entries of the blackboard: ``{result_1}``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol
from xml.etree import ElementTree

from annotations.language.forms import (
    NAMING,
    NOUN,
    PERSON,
)
from annotations.language.plans.plan import (
    Described,
    Named,
    Number,
    OpenValue,
    Operator,
    Referred,
    StepResult,
    Value,
    Words,
)

TREE = "Command"
RESULT = "result"
OPERATOR = "operator"
FALLBACK = "step_failed"
_NAMING = frozenset((NOUN, NAMING))  # what gives a thing its noun and a person a name
_NO_NAME = re.compile(r"[^A-Za-z0-9_]")
_RESERVED = frozenset(("name", "id", RESULT))
# The nodes of BehaviorTree.CPP 4.9 and of its predecessors, the tags of its XML, and the name of our tree: an action
# of one of these names would be taken for something else, or not be registered.
TAKEN_NAMES = frozenset(
    (
        *("Sequence", "SequenceStar", "SequenceWithMemory", "AsyncSequence", "ReactiveSequence"),
        *("Fallback", "AsyncFallback", "ReactiveFallback", "Parallel", "ParallelAll"),
        *("IfThenElse", "WhileDoElse", "TryCatch", "ManualSelector"),
        *("Switch2", "Switch3", "Switch4", "Switch5", "Switch6"),
        *("Inverter", "ForceSuccess", "ForceFailure", "Repeat", "RunOnce", "Timeout", "Delay"),
        *("RetryUntilSuccessful", "RetryUntilSuccesful", "KeepRunningUntilFailure"),
        *("Precondition", "SkipUnlessUpdated", "WaitValueUpdate", "WasEntryUpdated"),
        *("LoopInt", "LoopBool", "LoopDouble", "LoopString", "ConsumeQueue"),
        *("BlackboardCheckInt", "BlackboardCheckDouble", "BlackboardCheckString"),
        *("BlackboardCheckBool", "AlwaysSuccess", "AlwaysFailure", "Sleep", "TestNode"),
        *("Script", "ScriptCondition", "SetBlackboard", "UnsetBlackboard", "SubTreePlus"),
        *("root", "Root", "BehaviorTree", "TreeNodesModel", "include", "MetadataFields"),
        *("Action", "Condition", "Control", "Decorator", "SubTree"),
        *("input_port", "output_port", "inout_port", TREE),
    )
)


class TreeStep(Protocol):
    """A step of a plan, or of a task plan, as a node."""

    @property
    def number(self) -> int: ...
    @property
    def action(self) -> str: ...
    @property
    def arguments(self) -> Sequence[tuple[str, Value | Operator]]: ...
    @property
    def text(self) -> str: ...
    @property
    def gives_result(self) -> bool: ...


class Steps(Protocol):
    """What has steps in the order in which a robot does them."""

    @property
    def steps(self) -> Sequence[TreeStep]: ...


@dataclass(frozen=True, slots=True)
class Robust:
    """How a tree tries each step: up to ``tries`` times, each for at most ``seconds``.

    What fails then goes to the action ``fallback``, whose ports are the number and the text of the step. Where it
    succeeds the tree goes on with the next step.
    """

    tries: int = 3
    seconds: float = 120.0
    fallback: str = FALLBACK


def to_behavior_tree(plan: Steps, robust: Robust | None = None) -> str:
    """Return the plan as XML: a sequence of actions and the ports of each.

    ``robust`` wraps each action in ``Fallback``, ``RetryUntilSuccessful`` and ``Timeout``.
    """
    root = ElementTree.Element("root", {"BTCPP_format": "4", "main_tree_to_execute": TREE})
    tree = ElementTree.SubElement(root, "BehaviorTree", {"ID": TREE})
    sequence = ElementTree.SubElement(tree, "Sequence", {"name": "plan"})
    ports: dict[str, dict[str, None]] = {}
    giving: set[str] = set()
    for step in plan.steps:
        values = {port_name(name): _port(value) for name, value in step.arguments}
        action = node_name(step.action)
        ports.setdefault(action, {}).update(dict.fromkeys(values))
        if step.gives_result:
            values[RESULT] = _blackboard(step.number)
            giving.add(action)
        name = _plain(f"{step.number} {step.text}")
        attributes = {"ID": action, "name": name, **values}
        parent = sequence if robust is None else _tries(sequence, robust, name)
        ElementTree.SubElement(parent, "Action", attributes)
        if robust is not None:
            failed = {"number": str(step.number), "text": _plain(step.text)}
            fallback = node_name(robust.fallback)
            ports.setdefault(fallback, {}).update(dict.fromkeys(failed))
            ElementTree.SubElement(sequence[-1], "Action", {"ID": fallback, **failed})
    model = ElementTree.SubElement(root, "TreeNodesModel")
    for action, names in ports.items():
        node = ElementTree.SubElement(model, "Action", {"ID": action})
        for name in names:
            ElementTree.SubElement(node, "input_port", {"name": name, "type": "std::string"})
        if action in giving:
            ElementTree.SubElement(node, "output_port", {"name": RESULT, "type": "std::string"})
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _tries(sequence: ElementTree.Element, robust: Robust, name: str) -> ElementTree.Element:
    """Add what tries one action again and again; return the node that the action goes into."""
    either = ElementTree.SubElement(sequence, "Fallback", {"name": name})
    tries = {"num_attempts": str(robust.tries)}
    retry = ElementTree.SubElement(either, "RetryUntilSuccessful", tries)
    return ElementTree.SubElement(retry, "Timeout", {"msec": str(round(robust.seconds * 1000))})


def node_name(action: str) -> str:
    """Return a name that BehaviorTree.CPP takes for a node: none that it has itself."""
    name = _NO_NAME.sub("_", action)
    return name if name[:1].isalpha() and name not in TAKEN_NAMES else f"a_{name}"


def port_name(argument: str) -> str:
    """Return a name that BehaviorTree.CPP takes for a port: none of its reserved words."""
    name = _NO_NAME.sub("_", argument)
    return name if name[:1].isalpha() and name.casefold() not in _RESERVED else f"p_{name}"


def _port(value: Value | Operator) -> str:
    if isinstance(value, Operator):
        return OPERATOR
    if isinstance(value, StepResult):
        return _blackboard(value.step)
    if isinstance(value, Number):
        return str(value.value)
    if isinstance(value, Named | Words):
        return _plain(value.text)
    if noun := _only_noun(value):
        return _plain(noun)
    assert isinstance(value, Described | OpenValue | Referred)
    return "json:" + json.dumps(value.as_json(), ensure_ascii=False, separators=(",", ":"))


def _only_noun(value: Value) -> str:
    """Return the noun or the name of what is described by nothing else; empty where more is said of it."""
    if isinstance(value, Referred):
        return _only_noun(value.value)
    if isinstance(value, Named):
        return value.text
    if not isinstance(value, Described) or value.of is not None:
        return ""
    said = [each for each in value.conditions if each.predicate != PERSON or each.values]
    if not said and value.conditions:
        return PERSON
    if len(said) != 1 or said[0].predicate not in _NAMING or len(said[0].values) != 1:
        return ""
    (noun,) = said[0].values
    return noun.text if isinstance(noun, Named | Words) else ""


def _blackboard(step: int) -> str:
    return f"{{result_{step}}}"


def _plain(text: str) -> str:
    """Return a text that is not read as an entry of the blackboard."""
    return text.replace("{", "(").replace("}", ")")
