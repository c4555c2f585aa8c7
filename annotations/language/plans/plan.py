"""A plan as data for a robot: its steps, the values of their arguments, and what stands in its way."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cache
from pathlib import Path
from typing import Any, ClassVar, Generic, Protocol, TypeAlias, TypeVar

ASK = "ask_operator"
_FOLDER = Path(__file__).parent


class Trouble(StrEnum):
    """What can be wrong with a plan."""

    NOT_UNDERSTOOD = "not_understood"
    NO_ACTION = "no_action"
    MISSING_ARGUMENT = "missing_argument"
    NO_ANTECEDENT = "no_antecedent"
    OPEN_SLOT = "open_slot"
    AMBIGUOUS = "ambiguous"
    UNKNOWN_ENTITY = "unknown_entity"
    SUPERLATIVE_WITHOUT_SET = "superlative_without_set"
    TOO_LONG = "too_long"


@dataclass(frozen=True, slots=True)
class PlanProblem:
    """One problem, in a sentence with a hint. ``step`` counts from 1; 0 is the whole plan."""

    trouble: Trouble
    step: int
    message: str
    hint: str = ""

    def as_json(self) -> dict[str, Any]:
        return {
            "code": str(self.trouble),
            "step": self.step,
            "message": self.message,
            "hint": self.hint,
        }


@dataclass(frozen=True, slots=True)
class ActionName:
    """What a robot calls an action and its arguments; an argument that is not named keeps its name."""

    name: str
    arguments: Mapping[str, str] = field(default_factory=dict, hash=False)


@dataclass(frozen=True, slots=True)
class Step:
    """One action. ``predicate`` is that of the form, ``ask_operator`` for a question to a person.

    ``text`` says the step in English. A step whose result a later one uses ``gives_result``.
    """

    number: int
    action: str
    predicate: str
    arguments: tuple[tuple[str, Value], ...]
    text: str
    gives_result: bool = False

    def as_json(self) -> dict[str, Any]:
        return {
            "number": self.number,
            "action": self.action,
            "predicate": self.predicate,
            "text": self.text,
            "arguments": {name: value.as_json() for name, value in self.arguments},
            "gives_result": self.gives_result,
        }


class AsData(Protocol):
    """What can be said in plain data."""

    def as_json(self) -> dict[str, Any]: ...


StepT = TypeVar("StepT", bound=AsData)
ProblemT = TypeVar("ProblemT", bound=AsData)


@dataclass(frozen=True, slots=True)
class SaidWords:
    """Words of an utterance, in its characters ``start`` to ``end``; None where it does not have them so."""

    text: str
    start: int | None = None
    end: int | None = None

    def as_json(self) -> dict[str, Any]:
        return {"text": self.text, "start": self.start, "end": self.end}


@dataclass(frozen=True, slots=True)
class OpenArgument:
    """What is not settled of an argument, and the question that settles it.

    ``words`` of the utterance stand there and name nothing that is known. ``likely`` is a guess. ``asked_in`` is the
    number of the step that asks; 0 where no step does.
    """

    argument: str
    question: str
    entity_class: str = ""
    words: tuple[SaidWords, ...] = ()
    likely: str | None = None
    asked_in: int = 0

    def as_json(self) -> dict[str, Any]:
        return {
            "argument": self.argument,
            "question": self.question,
            "entity_class": self.entity_class,
            "words": [each.as_json() for each in self.words],
            "likely": self.likely,
            "asked_in": self.asked_in or None,
        }


@dataclass(frozen=True, slots=True)
class Unresolved:
    """A step of the form that does not ground, with what is known of it and what is ``open``.

    ``steps`` are the numbers of the steps that wait for it. ``arguments`` are what is known; an ``OpenValue`` stands
    for what is not. ``predicate`` is empty for a part that says nothing to do: a question stands in its place.
    """

    steps: tuple[int, ...]
    action: str
    predicate: str
    text: str
    arguments: tuple[tuple[str, TaskValue], ...]
    open: tuple[OpenArgument, ...]

    def as_json(self) -> dict[str, Any]:
        return {
            "steps": list(self.steps),
            "action": self.action,
            "predicate": self.predicate,
            "text": self.text,
            "arguments": {name: value.as_json() for name, value in self.arguments},
            "open": [each.as_json() for each in self.open],
        }


@dataclass(frozen=True, slots=True)
class PlanOf(Generic[StepT, ProblemT]):
    """Steps in the order in which a robot does them, the problems of the plan, and what of it is not settled.

    ``version`` is that of the data, which follow the schema of the kind of plan.
    """

    steps: tuple[StepT, ...]
    problems: tuple[ProblemT, ...] = ()
    unresolved: tuple[Unresolved, ...] = ()
    version: ClassVar[int] = 1

    @property
    def is_executable(self) -> bool:
        """Whether a robot can do it without asking anybody."""
        return bool(self.steps) and not self.problems and not self.unresolved

    def as_json(self) -> dict[str, Any]:
        """Return plain data that follow the schema."""
        return {
            "version": self.version,
            "is_executable": self.is_executable,
            "steps": [step.as_json() for step in self.steps],
            "problems": [problem.as_json() for problem in self.problems],
            "unresolved": [each.as_json() for each in self.unresolved],
        }


@dataclass(frozen=True, slots=True)
class Plan(PlanOf[Step, PlanProblem]):
    """The actions of a form; its data follow ``plan_schema``."""


@dataclass(frozen=True, slots=True)
class Named:
    """An entity of the ontology. ``attributes`` are those that a robot needs: room, category.

    ``doubt`` asks whether it is meant, where it is only likely.
    """

    entity_class: str
    text: str
    attributes: Mapping[str, str] = field(default_factory=dict, hash=False)
    doubt: OpenArgument | None = field(default=None, compare=False)

    def as_json(self) -> dict[str, Any]:
        return {
            "kind": "entity",
            "entity_class": self.entity_class,
            "text": self.text,
            "attributes": dict(self.attributes),
        }


@dataclass(frozen=True, slots=True)
class Words:
    """A text that is no entity: words to say, ``current``.

    ``is_of_robot`` marks the robot's own words, such as a question: it says them as they are. ``said`` is what it says
    in their place, where that is something else: "sentence" for the class whattosay. ``doubt`` asks what they name,
    where that should be an entity.
    """

    text: str
    is_of_robot: bool = field(default=False, compare=False)
    said: str = field(default="", compare=False)
    doubt: OpenArgument | None = field(default=None, compare=False)

    def as_json(self) -> dict[str, Any]:
        return {"kind": "text", "text": self.text}


@dataclass(frozen=True, slots=True)
class Number:
    """An integer."""

    value: int

    def as_json(self) -> dict[str, Any]:
        return {"kind": "number", "value": self.value}


@dataclass(frozen=True, slots=True)
class Condition:
    """Something that has to hold of what is described: ``at`` a place, ``sitting``."""

    predicate: str
    values: tuple[Value, ...] = ()

    def as_json(self) -> dict[str, Any]:
        return {"predicate": self.predicate, "values": [each.as_json() for each in self.values]}


@dataclass(frozen=True, slots=True)
class Described:
    """Something to be found by what is said of it. In one plan the same ``id`` is the same thing.

    ``of`` is the id of another described thing, of which this is the ``attribute``: her name.
    ``short_text`` is the text without where it is; empty where that is the text.
    """

    id: str
    text: str
    conditions: tuple[Condition, ...]
    attribute: str = ""
    of: Described | None = None
    short_text: str = field(default="", compare=False)

    def as_json(self) -> dict[str, Any]:
        if self.of is not None:
            owner = self.of.as_json()
            return {
                "kind": "attribute",
                "attribute": self.attribute,
                "text": self.text,
                "of": owner,
            }
        conditions = [each.as_json() for each in self.conditions]
        return {"kind": "description", "id": self.id, "text": self.text, "conditions": conditions}


@dataclass(frozen=True, slots=True)
class Referred:
    """What ``it`` or ``them`` stands for; ``word`` is what the command says."""

    word: str
    value: Named | Described

    def as_json(self) -> dict[str, Any]:
        return {**self.value.as_json(), "said": self.word}


@dataclass(frozen=True, slots=True)
class StepResult:
    """What an earlier step of the plan gives; ``step`` counts from 1."""

    step: int

    def as_json(self) -> dict[str, Any]:
        return {"kind": "result", "step": self.step}


@dataclass(frozen=True, slots=True)
class OpenValue:
    """An entity of a class that the command does not name; the plan asks the operator for it if it can."""

    entity_class: str

    def as_json(self) -> dict[str, Any]:
        return {"kind": "open", "entity_class": self.entity_class}


@dataclass(frozen=True, slots=True)
class Operator:
    """The person who gave the command, and the place where they are. Plans of forms have none, recipes do."""

    def as_json(self) -> dict[str, Any]:
        return {"kind": "operator"}


Value: TypeAlias = "Named | Words | Number | Described | Referred | StepResult | OpenValue"
TaskValue: TypeAlias = "Value | Operator"


@cache
def plan_schema_text() -> str:
    """Return the JSON Schema (2020-12) that ``Plan.as_json`` follows, as text."""
    return (_FOLDER / "plan.schema.json").read_text(encoding="utf-8")


def plan_schema() -> dict[str, Any]:
    """Return the JSON Schema that ``Plan.as_json`` follows."""
    schema: dict[str, Any] = json.loads(plan_schema_text())
    return schema


@cache
def behavior_tree_schema_text() -> str:
    """Return the XML Schema of what ``to_behavior_tree`` writes, as text."""
    return (_FOLDER / "behavior_tree.xsd").read_text(encoding="utf-8")
