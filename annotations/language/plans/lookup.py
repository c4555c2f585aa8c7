"""Look constants of a form up in the ontology, and see which places of predicates take entities."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from annotations.language.english import ANY_OBJECT, spellings
from annotations.language.grounding import QUESTION_WORD
from annotations.language.ontology import Entity, Ontology
from annotations.language.plans.values import Named, Value, Words
from annotations.language.predicates import ENTITY_KINDS, ArgumentKind, Predicate

# Words in the place of an entity that name none: any category, any question, where the robot is.
NEUTRAL_WORDS = frozenset((ANY_OBJECT, QUESTION_WORD, "current"))
_SPOKEN = frozenset((ArgumentKind.WHATTOSAY, ArgumentKind.QUESTION))
_KINDS = {
    ("is_a", 1): frozenset((ArgumentKind.OBJECT, ArgumentKind.CATEGORY)),
    ("name", 1): frozenset((ArgumentKind.NAME,)),
    ("at", 1): frozenset((ArgumentKind.LOCATION, ArgumentKind.ROOM)),
    ("go", 0): frozenset((ArgumentKind.LOCATION, ArgumentKind.ROOM)),
    **{
        (action, 1): frozenset((ArgumentKind.LOCATION, ArgumentKind.ROOM))
        for action in ("put", "guide", "follow")
    },
}
# Entity class → the attributes that a robot needs.
_ATTRIBUTES = {
    "object": ("category",),
    "location": ("room",),
    "name": ("gender",),
    "question": ("answer",),
}


class Lookup:
    """Finds entities by text, alias or singular, ignoring case."""

    def __init__(self, ontology: Ontology, predicates: Mapping[str, Predicate]) -> None:
        self._predicates = predicates
        self._rows: defaultdict[str, list[Entity]] = defaultdict(list)
        for entity in ontology.entities:
            singular = entity.attribute("singular") if entity.entity_class == "category" else None
            names = {entity.text, *entity.aliases, *([singular] if singular else [])}
            for name in {
                spelling.casefold() for each in names for spelling in (each, *spellings(each))
            }:
                self._rows[name].append(entity)

    def value(self, text: str, predicate: str, place: int) -> tuple[Value, bool]:
        """Return the value of a text as an argument, and whether an entity was expected but not found."""
        kinds = self._kinds(predicate, place)
        rows = self._rows.get(text.casefold(), [])
        fitting = [each for each in rows if each.entity_class in kinds] or rows
        if fitting:
            return _named(text, fitting), False
        is_missing = bool(kinds - _SPOKEN) and text.casefold() not in NEUTRAL_WORDS
        return Words(text), is_missing

    def _kinds(self, predicate: str, place: int) -> frozenset[ArgumentKind]:
        """Return the entity kinds that a predicate takes at a place."""
        declared = self._predicates.get(predicate)
        if declared is None or not declared.signatures:
            return _KINDS.get((predicate, place), frozenset())
        kinds = (each.arguments[place : place + 1] for each in declared.signatures)
        return frozenset(kind for some in kinds for kind in some) & ENTITY_KINDS


def _named(text: str, rows: list[Entity]) -> Named:
    """Return the entity of some rows, with the attributes that they agree on."""
    entity_class = rows[0].entity_class
    rows = [each for each in rows if each.entity_class == entity_class]
    attributes: dict[str, str] = {}
    for name in _ATTRIBUTES.get(entity_class, ()):
        values = {each.attribute(name) for each in rows}
        value = values.pop() if len(values) == 1 else None
        if value:
            attributes[name] = value
    exact = [each.text for each in rows if each.text.casefold() == text.casefold()]
    return Named(entity_class, (exact or [text])[0], attributes)
