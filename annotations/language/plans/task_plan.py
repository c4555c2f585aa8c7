"""A task plan: the primitives of a team's robot in the order in which it does them."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cache
from pathlib import Path
from typing import Any

from annotations.language.plans.plan import PlanOf, PlanProblem, TaskValue
from annotations.language.plans.rows import Primitive

_FOLDER = Path(__file__).parent


class RecipeTrouble(StrEnum):
    """What can be wrong with a task plan beside what is wrong with the plan that it is made of."""

    NO_RECIPE = "no_recipe"
    NO_RESULT = "no_result"
    HANDS_FULL = "hands_full"
    NOT_HELD = "not_held"
    UNKNOWN_PLACE = "unknown_place"


@dataclass(frozen=True, slots=True)
class TaskProblem:
    """One problem, in a sentence with a hint. ``step`` is that of the task plan; 0 is the whole plan.

    ``code`` is a Trouble of the form's plan or a RecipeTrouble.
    """

    code: str
    step: int
    message: str
    hint: str = ""

    @classmethod
    def of_plan(cls, problem: PlanProblem, step: int) -> TaskProblem:
        """Return a problem of the form's plan as one of the task plan."""
        return cls(str(problem.trouble), step, problem.message, problem.hint)

    def as_json(self) -> dict[str, Any]:
        return {
            "code": str(self.code),
            "step": self.step,
            "message": self.message,
            "hint": self.hint,
        }


@dataclass(frozen=True, slots=True)
class TaskStep:
    """One primitive with the values of its arguments.

    ``place`` is where the robot is when the step is done; None where nobody knows, as behind a person who
    leads. ``holds`` is what it holds then, ``releases`` what the step lets go. ``requires`` are the
    numbers of the steps without which this one cannot be done. ``source`` is the number of the step of the
    form's plan that it belongs to. It ``is_proposed`` where no recipe says so: nobody has written what it does.
    """

    number: int
    primitive: Primitive
    arguments: tuple[tuple[str, TaskValue], ...]
    text: str = field(default="", compare=False)
    place: TaskValue | None = None
    holds: TaskValue | None = None
    releases: TaskValue | None = None
    requires: tuple[int, ...] = ()
    source: int = 0
    is_proposed: bool = False

    @property
    def action(self) -> str:
        """The name of the primitive, as the node of a behaviour tree has it."""
        return self.primitive.name

    @property
    def gives_result(self) -> bool:
        return self.primitive.gives_result

    def as_json(self) -> dict[str, Any]:
        return {
            "number": self.number,
            "primitive": self.primitive.name,
            "text": self.text,
            "arguments": {name: value.as_json() for name, value in self.arguments},
            "place": self.place and self.place.as_json(),
            "holds": self.holds and self.holds.as_json(),
            "releases": self.releases and self.releases.as_json(),
            "requires": list(self.requires),
            "gives_result": self.gives_result,
            "source": self.source,
            **({"is_proposed": True} if self.is_proposed else {}),
        }


@dataclass(frozen=True, slots=True)
class TaskPlan(PlanOf[TaskStep, TaskProblem]):
    """The primitives of a robot; its data follow ``task_plan_schema``.

    ``sends_to`` is the place to go to with which the command ends: a command after it that looks for something
    looks there. None where it ends with something else.
    """

    sends_to: TaskValue | None = field(default=None, compare=False)


@cache
def task_plan_schema_text() -> str:
    """Return the JSON Schema (2020-12) that ``TaskPlan.as_json`` follows, as text."""
    return (_FOLDER / "task_plan.schema.json").read_text(encoding="utf-8")


def task_plan_schema() -> dict[str, Any]:
    """Return the JSON Schema that ``TaskPlan.as_json`` follows."""
    schema: dict[str, Any] = json.loads(task_plan_schema_text())
    return schema
