"""Look constants of a form up in the ontology, and see which places of predicates take entities."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from itertools import pairwise

from annotations.language.forms import (
    ATTRIBUTES,
    KIND_CLASS,
    PLACE_CLASS,
    QUESTION_CLASS,
    SAYING_CLASS,
    TAKEN,
)
from annotations.language.grounding import QUESTION_WORD
from annotations.language.plans.plan import Named, Value, Words
from annotations.language.texts import ANY_OBJECT, KINDS_OF_PLACES, spellings
from annotations.language.world import Entity, Ontology, Predicate, is_entity_kind

# Words in the place of an entity that name none: any category, any question, where the robot is.
NEUTRAL_WORDS = frozenset((ANY_OBJECT, QUESTION_WORD, "current"))
_SPOKEN = frozenset((SAYING_CLASS, QUESTION_CLASS))
# A word for a kind of place of so many letters can begin another one: trash, but not bin.
LONG = 5


class Lookup:
    """Finds entities by text, alias or singular, ignoring case."""

    def __init__(self, ontology: Ontology, predicates: Mapping[str, Predicate]) -> None:
        self.classes = ontology.classes
        self.class_of_text = ontology.class_of_text
        self._predicates = predicates
        self._locations = ontology.of_class(PLACE_CLASS)
        self._rows: defaultdict[str, list[Entity]] = defaultdict(list)
        for entity in ontology.entities:
            singular = entity.attribute("singular") if entity.entity_class == KIND_CLASS else None
            names = {entity.text, *entity.aliases, *([singular] if singular else [])}
            for name in {
                spelling.casefold() for each in names for spelling in (each, *spellings(each))
            }:
                self._rows[name].append(entity)

    def value(self, text: str, predicate: str, place: int) -> tuple[Value, bool]:
        """Return the value of a text as an argument, and whether an entity was expected but not found."""
        declared = self._predicates.get(predicate)
        if declared is None or not declared.signatures:
            kinds = TAKEN.get((predicate, place), frozenset())
        else:
            taken = {
                each.arguments[place] for each in declared.signatures if each.arguments[place:]
            }
            kinds = frozenset(filter(is_entity_kind, taken))
        rows = self._rows.get(text.casefold(), [])
        fitting = [each for each in rows if each.entity_class in kinds] or rows
        if fitting:
            entity_class = fitting[0].entity_class
            same_class = [each for each in fitting if each.entity_class == entity_class]
            exact = [each.text for each in same_class if each.text.casefold() == text.casefold()]
            return _named((exact or [text])[0], same_class), False
        is_missing = bool(kinds - _SPOKEN) and text.casefold() not in NEUTRAL_WORDS
        if is_missing and len(places := self.places_called(text)) == 1:
            return places[0], False
        return Words(text), is_missing

    def places_called(self, text: str) -> tuple[Named, ...]:
        """Return the locations that a word for a kind of place can mean, which may be called something else.

        Where some have the very word in their name, it means these: "the trash" is the trash bin, and not the
        garbage bin beside it. Else it means those with another word of its kind.
        """
        said = text.casefold()
        kind = next((each for each in KINDS_OF_PLACES if said in each), frozenset())
        rows: dict[str, list[Entity]] = {}
        for words in ({said} & kind, kind):
            for entity in self._locations:
                if any(_has_word(name, words) for name in (entity.text, *entity.aliases)):
                    rows.setdefault(entity.text, []).append(entity)
            if rows:
                break
        return tuple(_named(name, of_name) for name, of_name in rows.items())


def _has_word(name: str, words: Collection[str]) -> bool:
    """Return whether a name has one of the words, also joined to the next one: "trashbin", "waste basket"."""
    parts = name.casefold().replace("-", " ").split()
    pairs = [first + second for first, second in pairwise(parts)]
    long = tuple(each for each in words if len(each) >= LONG)
    return any(each in words or each.startswith(long) for each in (*parts, *pairs))


def _named(text: str, rows: Sequence[Entity]) -> Named:
    """Return an entity, with the attributes that all of its rows agree on."""
    entity_class = rows[0].entity_class
    attributes: dict[str, str] = {}
    if name := ATTRIBUTES.get(entity_class):
        values = {each.attribute(name) for each in rows}
        value = values.pop() if len(values) == 1 else None
        if value:
            attributes[name] = value
    return Named(entity_class, text, attributes)
