"""Template filters: the steps of a task plan, which come as plain data."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from django import template

from annotations.language.plans import Primitive
from annotations.language.texts import Problem

register = template.Library()


@register.filter
def call(step: Mapping[str, Any]) -> str:
    """Write the primitive of a step with its arguments: ``give(coke, operator)``, ``say("a joke")``."""
    values = ", ".join(
        f'"{each["text"]}"' if each["kind"] == "text" else value_text(each)
        for each in step["arguments"].values()
    )
    return f"{step['primitive']}({values})"


@register.filter
def waiting_with(plan: Mapping[str, Any], number: int) -> list[dict[str, Any]]:
    """Return what of a plan is not resolved and waits with step ``number``; with 0, what no step waits for."""
    return [each for each in plan["unresolved"] if number in (each["steps"] or [0])]


@register.filter
def as_json(value: Mapping[str, Any]) -> str:
    """Write plain data as JSON that people can read."""
    return json.dumps(value, ensure_ascii=False, indent=2)


@register.filter
def signature(primitive: Primitive) -> str:
    """Write a primitive with its parameters: ``give(thing, person)``."""
    return f"{primitive.name}({', '.join(map(str, primitive.parameters))})"


@register.filter
def facts(step: Mapping[str, Any]) -> list[str]:
    """Say where a step happens, what the robot holds and releases, and which steps have to come before it."""
    said = [_where(step["place"])]
    said += [f"{name} {value_text(step[name])}" for name in ("holds", "releases") if step[name]]
    if step["requires"]:
        said.append(f"after {', '.join(map(str, step['requires']))}")
    return said


def value_text(value: Mapping[str, Any] | None) -> str:
    """Write a value of a plan in a few words; empty for none."""
    if not value:
        return ""
    match value["kind"]:
        case "operator":
            return "operator"
        case "result":
            return f"result of {value['step']}"
        case "number":
            return str(value["value"])
        case "open":
            return f"which {value['entity_class']}".strip()
    return str(value["text"])


def _where(place: Mapping[str, Any] | None) -> str:
    if place is None:
        return "somewhere"
    match place["kind"]:
        case "operator":
            return "at the operator"
        case "result":
            return f"where step {place['step']} says"
    return f"at {value_text(place)}"


@register.filter
def excerpt_in(problem: Problem, text: str) -> str:
    """Return the part of a text around the place of a problem, with a caret below it."""
    return problem.position.excerpt(text)
