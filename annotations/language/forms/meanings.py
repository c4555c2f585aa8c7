"""What classes and predicates mean to the core, as ``meanings.toml`` beside this module names them."""

from __future__ import annotations

import tomllib
from pathlib import Path

PERSON, THING, THINGS, PLACE, WORDS = "person", "thing", "things", "place", "words"

_meanings = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
_OF_CLASS: dict[str, str] = _meanings["classes"]
_predicates = _meanings["predicates"]
NOUN: str = _predicates["noun"]
NAMING: str = _predicates["naming"]
PLACING: str = _predicates["placing"]
# A λ of which one of these is said describes a person.
PERSON_PREDICATES = frozenset(_predicates["persons"])
_roles = _meanings["roles"]
THING_CLASS: str = _roles["thing"]
KIND_CLASS: str = _roles["kind"]
PERSON_CLASS: str = _roles["person"]
PLACE_CLASS: str = _roles["place"]
ROOM_CLASS: str = _roles["room"]
QUESTION_CLASS: str = _roles["question"]
SAYING_CLASS: str = _roles["saying"]
PERSONAL_CLASSES = frozenset(
    _predicates["saying_persons"]
)  # what is of one of these is said of a person
PERSONAL_WORDS = frozenset(_predicates["personal_words"])
ATTRIBUTES: dict[str, str] = _meanings["attributes"]  # class → the attribute that a robot needs
# Predicate and place → the classes that it takes, where nothing declares it.
TAKEN = {
    (name, int(place)): frozenset(classes)
    for name, places in _meanings["taken"].items()
    for place, classes in places.items()
}
PLACE_CLASSES = frozenset(each for each, meaning in _OF_CLASS.items() if meaning == PLACE)


def kind_of_class(entity_class: str) -> str:
    """Return what an entity of a class is, for a reference: a person, a thing or several; empty for a place, and for
    what no reference stands for.

    An entity of a class that only a world of its own has is a thing.
    """
    meaning = _OF_CLASS.get(entity_class, THING if entity_class else "")
    return "" if meaning in (PLACE, WORDS) else meaning
