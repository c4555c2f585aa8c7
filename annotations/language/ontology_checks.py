"""What is odd in an ontology although it can be read: warnings, each at its row."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from annotations.language.entities import Entity, Ontology
from annotations.language.errors import Problem, warning
from annotations.language.symbols import TYPES

DIFFICULTIES = ("easy", "moderate", "high")
_FLAGS = ("isBeacon", "isPlacement")


def ontology_problems(ontology: Ontology) -> Iterator[Problem]:
    """Warnings about values outside those known, repeated places and places that are missing."""
    for entity in ontology.entities:
        yield from _odd_values(entity)
    yield from _repeated_locations(ontology)
    yield from _missing_places(ontology)


def _odd_values(entity: Entity) -> Iterator[Problem]:
    difficulty = entity.attribute("difficulty")
    if difficulty and difficulty not in DIFFICULTIES:
        yield _odd(entity, "difficulty", difficulty, DIFFICULTIES)
    kind = entity.attribute("type")
    if entity.entity_class == "object" and kind and kind.lower() not in TYPES["object"]:
        yield _odd(entity, "type", kind, TYPES["object"])
    gender = entity.attribute("gender")
    if entity.entity_class == "name" and gender and gender.lower() not in TYPES["name"]:
        yield _odd(entity, "gender", gender, TYPES["name"])
    for flag in _FLAGS if entity.entity_class == "location" else ():
        value = entity.attribute(flag)
        if value and value.lower() not in ("true", "false"):
            yield _odd(entity, flag, value, ("true", "false"))


def _odd(entity: Entity, attribute: str, value: str, known: tuple[str, ...]) -> Problem:
    message = f"the {attribute} of {entity.text} is {value}"
    return warning(entity.position, message, f"known are {', '.join(known)}")


def _repeated_locations(ontology: Ontology) -> Iterator[Problem]:
    counts = Counter((each.attribute("room"), each.text) for each in ontology.of_class("location"))
    for entity in ontology.of_class("location"):
        key = (entity.attribute("room"), entity.text)
        if counts[key] > 1:
            counts[key] = 0  # one warning for all rows of the same place
            message = f"the location {entity.text} stands more than once in the {key[0]}"
            yield warning(entity.position, message, "keep one, or rename the others")


def _missing_places(ontology: Ontology) -> Iterator[Problem]:
    """Categories whose default location, or its room, is nowhere. Without locations all are."""
    rooms = {each.text for each in ontology.of_class("room")}
    places = {(each.attribute("room"), each.text) for each in ontology.of_class("location")}
    for entity in ontology.of_class("category") if rooms else ():
        place, room = entity.attribute("defaultLocation"), entity.attribute("room")
        if room and room not in rooms:
            message = f"the room {room} of the category {entity.text} does not exist"
            yield warning(entity.position, message, "name a room of locations.xml")
        elif place and not any(place == name and room in (None, at) for at, name in places):
            where = f" in the {room}" if room else ""
            message = f"the default location {place} of {entity.text} does not exist{where}"
            yield warning(entity.position, message, "name a location of locations.xml")
