"""The values of a plan, as frozen data: what the arguments of its actions are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias


@dataclass(frozen=True, slots=True)
class Named:
    """An entity of the ontology. ``attributes`` are those that a robot needs: room, category."""

    entity_class: str
    text: str
    attributes: Mapping[str, str] = field(default_factory=dict, hash=False)

    def as_json(self) -> dict[str, Any]:
        return {
            "kind": "entity",
            "entity_class": self.entity_class,
            "text": self.text,
            "attributes": dict(self.attributes),
        }


@dataclass(frozen=True, slots=True)
class Words:
    """A text that is no entity: words to say, ``current``."""

    text: str

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
    """

    id: str
    text: str
    conditions: tuple[Condition, ...]
    attribute: str = ""
    of: Described | None = None

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
class Result:
    """What an earlier step of the plan gives; ``step`` counts from 1."""

    step: int

    def as_json(self) -> dict[str, Any]:
        return {"kind": "result", "step": self.step}


@dataclass(frozen=True, slots=True)
class Open:
    """An entity of a class that nothing names; the plan asks the operator for it where it can."""

    entity_class: str

    def as_json(self) -> dict[str, Any]:
        return {"kind": "open", "entity_class": self.entity_class}


Value: TypeAlias = "Named | Words | Number | Described | Result | Open"
