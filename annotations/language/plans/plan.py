"""A plan: the steps of a command as data for a robot, and what stands in its way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from annotations.language.plans.values import Value

VERSION = 1  # of the JSON that ``Plan.as_json`` writes; see plan.schema.json
ASK = "ask_operator"


class Trouble(StrEnum):
    """What can be wrong with a plan."""

    NOT_UNDERSTOOD = "not_understood"
    NO_ACTION = "no_action"
    MISSING_ARGUMENT = "missing_argument"
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


@dataclass(frozen=True, slots=True)
class Plan:
    """Steps in the order in which a robot does them, and the problems of the plan."""

    steps: tuple[Step, ...]
    problems: tuple[PlanProblem, ...] = ()

    @property
    def is_executable(self) -> bool:
        """Whether a robot can do it without asking anybody."""
        return bool(self.steps) and not self.problems

    def as_json(self) -> dict[str, Any]:
        """Return plain data that follow ``PLAN_SCHEMA``."""
        return {
            "version": VERSION,
            "is_executable": self.is_executable,
            "steps": [step.as_json() for step in self.steps],
            "problems": [problem.as_json() for problem in self.problems],
        }
