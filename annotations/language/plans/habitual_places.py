"""Where things usually are, by the ontology."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from annotations.language.forms import (
    KIND_CLASS,
)
from annotations.language.plans.descriptions import AT
from annotations.language.plans.lookup import Lookup
from annotations.language.plans.plan import Described, Named, TaskValue
from annotations.language.texts import spellings
from annotations.language.world import Ontology

UsualPlaces: TypeAlias = Mapping[str, Named]


def usual_places(ontology: Ontology, lookup: Lookup | None = None) -> UsualPlaces:
    """Return the default location of each category that has one, under each of its names; the first where it has
    several.

    Args:
        ontology: its categories say where their things are kept.
        lookup: of the ontology, to be shared; made here by default.
    """
    lookup = lookup or Lookup(ontology, {})
    places: dict[str, Named] = {}
    for category in ontology.of_class(KIND_CLASS):
        text = category.attribute("defaultLocation") or category.attribute("room")
        place, _ = lookup.value(text, AT, 1) if text else (None, False)
        if isinstance(place, Named):
            singular = category.attribute("singular")
            for noun in (category.text, *category.aliases, *([singular] if singular else [])):
                for name in (noun, *spellings(noun)):
                    places.setdefault(name.casefold(), place)
    return places


def usual_place(value: TaskValue, places: UsualPlaces) -> Named | None:
    """Return where a thing usually is, by its category; None if nothing says that."""
    conditions = value.conditions if isinstance(value, Described) else ()
    for each in (value, *(each for condition in conditions for each in condition.values)):
        if isinstance(each, Named):
            place = places.get(each.attributes.get("category", each.text).casefold())
            if place is not None:
                return place
    return None
