"""Say whether two task plans are the same."""

from __future__ import annotations

from typing import Any

from annotations.language.plans.plan import Described, TaskValue
from annotations.language.plans.task_plan import TaskPlan
from annotations.language.plans.values import content


def same_plan(first: TaskPlan, second: TaskPlan) -> bool:
    """Return whether two task plans have equal steps, up to the names of variables.

    The order of the conditions of a description does not matter, nor do texts. Plans that ask the operator
    are the same if they ask the same. See ``plan_key`` for comparing many.
    """
    return plan_key(first) == plan_key(second)


def plan_key(plan: TaskPlan) -> tuple[Any, ...]:
    """Return a hashable value that two task plans share if and only if they are the same."""
    numbers: dict[str, int] = {}
    return tuple(
        (
            step.primitive.name,
            tuple((name, _identified(value, numbers)) for name, value in step.arguments),
        )
        for step in plan.steps
    )


def _identified(value: TaskValue, numbers: dict[str, int]) -> tuple[Any, int]:
    """Return the meaning of a value, and which of the described things it is, in the order of mention."""
    is_described = isinstance(value, Described)
    owner = (value.of or value) if isinstance(value, Described) else None
    number = numbers.setdefault(owner.id, len(numbers)) if owner else -1
    return content(value), number if is_described else -1
