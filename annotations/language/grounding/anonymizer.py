"""Replace the entities that a text names with class tokens."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum

from annotations.language.forms import (
    KIND_CLASS,
    QUESTION_CLASS,
    THING_CLASS,
    EntityClasses,
)
from annotations.language.texts import looks_plural, places_of, spellings
from annotations.language.world import Entity, Ontology

_TOKEN = re.compile(r"<\w+>|\w+|[^\w\s]")
# A grounded question becomes this word; the question itself is only in the note.
QUESTION_WORD = QUESTION_CLASS


class Likeness(IntEnum):
    """How a spelling relates to an entity; if several fit, the closest wins."""

    EXACT = 0
    ALIAS = 1
    INFLECTED = 2
    MEMBER = 3  # the name of a category, for one of its objects


@dataclass(frozen=True, slots=True)
class Span:
    """``original[start:end]`` names an entity and became ``token``.

    ``value`` is what a grounded form says: the entity's text, or the word for any object of a
    category. ``others`` are further rows that match the words equally well. ``likeness`` says how the
    words relate to the entity.
    """

    start: int
    end: int
    token: str
    entity_class: str
    entity: Entity
    value: str
    others: tuple[Entity, ...] = ()
    likeness: Likeness = Likeness.EXACT


@dataclass(frozen=True, slots=True)
class Anonymized:
    """``text`` is ``original`` with each span replaced and nothing else changed."""

    original: str
    text: str
    spans: tuple[Span, ...]

    @property
    def command(self) -> str:
        """The text written like a generated command: commas apart, single spaces."""
        return " ".join(self.text.replace(",", " , ").split())


@dataclass(frozen=True, slots=True)
class Reading:
    """One way to understand some words."""

    likeness: Likeness
    entity_class: str
    value: str
    entity: Entity


class Anonymizer:
    """Finds entities by the longest match of whole words, left to right, ignoring case.

    Texts, aliases, plurals and singulars count. An exact text wins over an alias, an alias over an
    inflection; after that the order of the ontology's classes decides. The singular of a category is a
    word for any of its objects, as in ``{object?}``, and becomes ``<object>``.

    Args:
        ontology: the entities that a text can name.
        numbered: tokens ``<object0>``, ``<object1>``, …, one number for each value.
    """

    def __init__(self, ontology: Ontology, numbered: bool = False) -> None:
        self._numbered = numbered
        readings: defaultdict[tuple[str, ...], list[Reading]] = defaultdict(list)
        for entity in ontology.entities:
            for words, reading in readings_of(entity, ontology.classes):
                if key := tuple(text for _, _, text in _folded(words)):
                    readings[key].append(reading)
        self._readings: dict[tuple[str, ...], tuple[Reading, ...]] = {}

        def rank(reading: Reading) -> tuple[int, int]:
            """Those of the lowest rank are meant: the closest likeness, and then the first class."""
            return reading.likeness, ontology.classes.place(reading.entity_class)

        for key, options in readings.items():
            closest = min(map(rank, options))
            likely = (each for each in options if rank(each) == closest)
            self._readings[key] = tuple(dict.fromkeys(likely))
        self._longest = max(map(len, self._readings), default=0)

    def anonymize(self, text: str) -> Anonymized:
        """Replace the names of entities; class tokens that are already there stay."""
        pieces: list[str] = []
        spans: list[Span] = []
        numbers: defaultdict[str, dict[str, int]] = defaultdict(dict)
        end = 0
        for start, stop, (best, *rest) in self._find_matches(text):
            token = f"<{best.entity_class}>"
            if self._numbered:
                of_class = numbers[best.entity_class]
                token = f"<{best.entity_class}{of_class.setdefault(best.value, len(of_class))}>"
            others = tuple(each.entity for each in rest)
            named = (best.entity_class, best.entity, best.value, others, best.likeness)
            spans.append(Span(start, stop, token, *named))
            pieces += [text[end:start], token]
            end = stop
        return Anonymized(text, "".join((*pieces, text[end:])), tuple(spans))

    def _find_matches(self, text: str) -> Iterator[tuple[int, int, tuple[Reading, ...]]]:
        """Yield (start, end, readings) for each match."""
        tokens = _folded(text)
        words = [word for _, _, word in tokens]
        place = 0
        while place < len(words):
            for length in range(min(self._longest, len(words) - place), 0, -1):
                readings = self._readings.get(tuple(words[place : place + length]))
                if readings:
                    last = place + length - 1
                    yield tokens[place][0], tokens[last][1], readings
                    place = last
                    break
            place += 1


def _folded(text: str) -> list[tuple[int, int, str]]:
    """Return where each word, class token and sign of a text begins and ends, and the word without its case."""
    return [(start, end, text[start:end].casefold()) for start, end in places_of(_TOKEN, text)]


def readings_of(entity: Entity, classes: EntityClasses) -> Iterator[tuple[str, Reading]]:
    """Yield every spelling of an entity of one of the classes with its reading."""
    entity_class, text = entity.entity_class, entity.text
    exact = Reading(Likeness.EXACT, entity_class, text, entity)
    yield text, exact
    if entity_class == QUESTION_CLASS:
        yield QUESTION_WORD, Reading(Likeness.EXACT, entity_class, QUESTION_WORD, entity)
    for alias in entity.aliases:
        yield alias, Reading(Likeness.ALIAS, entity_class, text, entity)
    if entity_class == KIND_CLASS:
        singular = entity.attribute("singular") or text
        if singular != text:
            yield singular, Reading(Likeness.EXACT, THING_CLASS, singular, entity)
            return
        # A class whose singular nobody has said, or is its plural: "a food" is one of its objects, too.
        for noun in _singulars_of(text):
            yield noun, Reading(Likeness.MEMBER, THING_CLASS, noun, entity)
    for noun in (text, *entity.aliases) if classes.has_plurals(entity_class) else ():
        for spelling in spellings(noun):
            yield spelling, Reading(Likeness.INFLECTED, entity_class, text, entity)


def _singulars_of(category: str) -> Iterator[str]:
    """Yield what one object of a category may be called: itself, or what it is the likely plural of."""
    if not looks_plural(category):
        yield category
    else:
        yield from (each for each in spellings(category) if len(each) < len(category))
