"""Check an ontology that was read: problems, each at its row."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from annotations.language.forms import (
    KIND_CLASS,
    PERSON_CLASS,
    PLACE_CLASS,
    ROOM_CLASS,
    THING_CLASS,
    TYPES,
)
from annotations.language.texts import MAX_ENTITY, LanguageError, Problem, require_name, warning_at
from annotations.language.world.entities import Entity, Ontology

DIFFICULTIES = ("easy", "moderate", "high")
_FLAGS = ("isBeacon", "isPlacement")


def ontology_problems(ontology: Ontology) -> Iterator[Problem]:
    """Yield errors for texts too long to store, and warnings for odd values and repeated or missing places."""
    for entity in ontology.entities:
        for text in (entity.text, *entity.aliases):
            try:
                require_name(text, entity.entity_class, MAX_ENTITY, entity.position)
            except LanguageError as error:
                yield error.problem
        difficulty = entity.attribute("difficulty")
        if difficulty and difficulty not in DIFFICULTIES:
            yield _warn_of_value(entity, "difficulty", difficulty, DIFFICULTIES)
        kind = entity.attribute("type")
        if entity.entity_class == THING_CLASS and kind and kind.lower() not in TYPES[THING_CLASS]:
            yield _warn_of_value(entity, "type", kind, TYPES[THING_CLASS])
        gender = entity.attribute("gender")
        if (
            entity.entity_class == PERSON_CLASS
            and gender
            and gender.lower() not in TYPES[PERSON_CLASS]
        ):
            yield _warn_of_value(entity, "gender", gender, TYPES[PERSON_CLASS])
        for flag in _FLAGS if entity.entity_class == PLACE_CLASS else ():
            value = entity.attribute(flag)
            if value and value.lower() not in ("true", "false"):
                yield _warn_of_value(entity, flag, value, ("true", "false"))
    counts = Counter((each.attribute("room"), each.text) for each in ontology.of_class(PLACE_CLASS))
    for entity in ontology.of_class(PLACE_CLASS):
        key = (entity.attribute("room"), entity.text)
        if counts[key] > 1:
            counts[key] = 0  # one warning for all rows of the same place
            message = f"the location {entity.text} occurs more than once in the {key[0]}"
            yield warning_at(entity.position, message, "keep one, or rename the others")
    # An ontology without rooms says nothing of places either.
    rooms = {each.text for each in ontology.of_class(ROOM_CLASS)}
    places: set[tuple[str | None, str]] = set()
    for location in ontology.of_class(PLACE_CLASS):
        places |= {(location.attribute("room"), location.text), (None, location.text)}
    for entity in ontology.of_class(KIND_CLASS) if rooms else ():
        place, room = entity.attribute("defaultLocation"), entity.attribute("room")
        if room and room not in rooms:
            message = f"the room {room} of the category {entity.text} does not exist"
            yield warning_at(entity.position, message, "name a room of locations.xml")
        elif place and (room, place) not in places:
            where = f" in the {room}" if room else ""
            message = f"the default location {place} of {entity.text} does not exist{where}"
            yield warning_at(entity.position, message, "name a location of locations.xml")


def _warn_of_value(entity: Entity, attribute: str, value: str, known: tuple[str, ...]) -> Problem:
    message = f"the {attribute} of {entity.text} is {value}"
    return warning_at(entity.position, message, f"known values are {', '.join(known)}")
