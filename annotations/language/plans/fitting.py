"""How well a form fits what was said: what it has and nobody said, what was said and it lacks, and who is where.

One step after any parser. A class of entities does not tell whether a place is where somebody is or where they go, but
the words around it do: "from the kitchen to the exit". What they tell is learned from the language (``WordUse``).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations
from math import inf

from annotations.language.forms import (
    KIND_CLASS,
    PERSON_PREDICATES,
    PLACE_CLASS,
    THING_CLASS,
    Constant,
    Form,
    Unknown,
    predicates,
    walk,
    with_part,
)
from annotations.language.grounding import Anonymized, Slot, Span, are_alike, words_of
from annotations.language.plans.qualifying import says_number
from annotations.language.plans.word_use import Place, Role, WordUse, role_at
from annotations.language.texts import CHOOSING_WORDS, NEGATIONS
from annotations.language.world import Ontology

EXCHANGED = 1.5  # log odds by which two mentions fit better where the other one is
ELSEWHERE = 4.0  # log odds by which a mention fits another role of the same action better
IMPOSSIBLE = (
    8.0  # log odds by which a place fits better where a thing is, and the thing where the place is
)
PLACE = PLACE_CLASS  # and what is alike: what may be of somebody, of something, or a destination
_THINGS = frozenset((THING_CLASS, KIND_CLASS))
GOAL = "argument 1"
MOST_MENTIONS = 8  # of one value that are compared
MOST_SLOTS = 16  # that are compared in pairs
_WORD = re.compile(r"<\w+>|\w+(?:['’]\w+)?|[^\w\s]")


class Left(StrEnum):
    """What was said and the form does not have."""

    ENTITY = "entity"
    ACTION = "action"
    ATTRIBUTE = "attribute"
    NUMBER = "number"
    NEGATION = "negation"


@dataclass(frozen=True, slots=True)
class LeftOut:
    """``utterance[start:end]`` says something that the form leaves out."""

    kind: Left
    text: str
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Exchange:
    """Two slots whose mentions fit better the other way round, by ``nats``; or one that has another role here."""

    slots: tuple[Slot, ...]
    nats: float

    @property
    def is_possible(self) -> bool:
        """Whether each of two slots can have what the other one has: a desk cannot be put on an apple."""
        classes = [each.entity_class for each in self.slots]
        return len(classes) == 2 and are_alike(*classes)


@dataclass(frozen=True, slots=True)
class Fit:
    """``not_said``: slots of which the utterance names no entity."""

    not_said: tuple[Slot, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    exchanged: tuple[Exchange, ...] = ()


@dataclass(frozen=True, slots=True)
class _Filled:
    """A slot, its role, and how the mentions stand that may fill it."""

    slot: Slot
    role: Role
    places: tuple[Place, ...]


def fit(
    form: Form, slots: Sequence[Slot], heard: Anonymized, use: WordUse, ontology: Ontology
) -> Fit:
    """Return how a form fits an utterance. Takes linear time in the words, quadratic in the slots up to ``MOST_SLOTS``.

    Args:
        form: with class tokens, as a parser gives it.
        slots: its slots with what fills them (``deanonymize``).
    """
    if isinstance(form, Unknown):
        return Fit()
    fillers = {each.casefold() for slot in slots for each in _fillers(slot)}
    fillers |= {str(each.value).casefold() for each in walk(form) if isinstance(each, Constant)}
    unused = [span for span in heard.spans if span.value.casefold() not in fillers]
    not_said = []
    for slot in slots:
        if not slot.entity_class or slot.is_named or slot.value is not None:
            continue
        other = next(
            (
                each
                for each in unused[:MOST_SLOTS]
                if slot.entity_class in _classes(each, heard, ontology)
            ),
            None,
        )
        if other is None:
            not_said.append(slot)
        else:
            unused.remove(other)
    words, starts = _words(heard)
    left_out = sorted(
        (
            *_entities_left_out(form, unused, heard, use, ontology),
            *_words_left_out(form, words, starts, use, heard),
        ),
        key=lambda each: each.start,
    )
    filled = _filled(form, slots, heard, use.places(words))
    actions = [each for each in dict.fromkeys(predicates(form)) if use.is_action(each)]
    exchanged = tuple(_exchanges(filled, actions, use))
    return Fit(tuple(not_said), tuple(left_out), exchanged)


def exchange(
    form: Form, slots: Sequence[Slot], exchanged: Exchange
) -> tuple[Form, tuple[str | None, ...]]:
    """Return the form with two slots exchanged, their classes too, and what then fills its class tokens, in order.

    Raises:
        ValueError: there are not two slots.
    """
    first, second = exchanged.slots
    form = with_part(form, first.path, Constant(second.token))
    form = with_part(form, second.path, Constant(first.token))
    other = {first.path: second.filler, second.path: first.filler}
    return form, tuple(other.get(each.path, each.filler) for each in slots if each.entity_class)


def best_fitting(scored: Sequence[tuple[float, Fit]], within: float = 3.0) -> list[int]:
    """Return the numbers of candidates in the order of how well they fit.

    Of those that are at most ``within`` nats below the best one, the ones without exchanged slots come first, then
    those with fewer things that nobody said or that they leave out. The others keep their order after them.
    """
    best = max((score for score, _ in scored), default=-inf)

    def misfit(number: int) -> tuple[bool, bool, int]:
        score, fits = scored[number]
        if score < best - within:
            return True, False, 0
        return False, bool(fits.exchanged), len(fits.not_said) + len(fits.left_out)

    return sorted(range(len(scored)), key=misfit)


def _fillers(slot: Slot) -> Iterator[str]:
    """Yield what fills a slot, or all that may where the utterance leaves that open."""
    if slot.filler is not None:
        yield slot.filler
    if slot.is_choice or slot.is_ambiguous:
        yield from slot.candidates


def _classes(span: Span, heard: Anonymized, ontology: Ontology) -> set[str]:
    """Return the classes that the words of a span may be of."""
    text = heard.original[span.start : span.end].casefold()
    others = {each.entity_class for each in span.others}
    namesakes = {
        each.entity_class
        for each in ontology.entities
        if text in (each.text.casefold(), *map(str.casefold, each.aliases))
    }
    return {span.entity_class, span.entity.entity_class, *others, *namesakes}


def _words(heard: Anonymized) -> tuple[list[str], list[tuple[int, int]]]:
    """Return the words of an utterance, a numbered token for each span, and where each stands."""
    words: list[str] = []
    places: list[tuple[int, int]] = []
    end = 0
    for number, span in enumerate((*heard.spans, None)):
        stop = span.start if span else len(heard.original)
        for match in _WORD.finditer(heard.original, end, stop):
            words.append(match[0].casefold().replace("’", "'"))
            places.append(match.span())
        if span:
            words.append(f"<{span.entity_class}{number}>")
            places.append((span.start, span.end))
            end = span.end
    return words, places


def _entities_left_out(
    form: Form, unused: Sequence[Span], heard: Anonymized, use: WordUse, ontology: Ontology
) -> Iterator[LeftOut]:
    """Yield what names an entity that no slot has; a pose or a gesture counts where somebody is meant."""
    has_person = not PERSON_PREDICATES.isdisjoint(predicates(form))
    is_choice = not CHOOSING_WORDS.isdisjoint(words_of(heard.text))  # "sitting, standing or lying?"
    for span in unused:
        is_word = ontology.classes.is_closed(span.entity_class)
        if is_word and is_choice:
            continue
        if not is_word or has_person or not use.is_of_people(span.entity_class):
            yield LeftOut(Left.ENTITY, heard.original[span.start : span.end], span.start, span.end)


def _words_left_out(
    form: Form,
    words: Sequence[str],
    places: Sequence[tuple[int, int]],
    use: WordUse,
    heard: Anonymized,
) -> Iterator[LeftOut]:
    used = frozenset(predicates(form))
    has_person = not PERSON_PREDICATES.isdisjoint(used)
    is_choice = not CHOOSING_WORDS.isdisjoint(words)  # "is it a man or a woman"
    seen = set()
    for word, (start, end) in zip(words, places, strict=True):
        named = use.named_by(word)
        if not named or named & used or word in seen:
            continue
        seen.add(word)
        if any(map(use.is_action, named)):
            yield LeftOut(Left.ACTION, heard.original[start:end], start, end)
        elif not is_choice and (has_person or not all(map(use.is_of_people, named))):
            yield LeftOut(Left.ATTRIBUTE, heard.original[start:end], start, end)
    if negation := next(
        (place for word, place in zip(words, places, strict=True) if word in NEGATIONS), None
    ):
        # Whatever it denies, no form says so: "the person who is not waving".
        yield LeftOut(Left.NEGATION, heard.original[slice(*negation)], *negation)
    if says_number(heard) and not any(
        isinstance(each, Constant) and isinstance(each.value, int) for each in walk(form)
    ):
        yield LeftOut(Left.NUMBER, "", 0, 0)


def _filled(
    form: Form, slots: Sequence[Slot], heard: Anonymized, places: Sequence[Place | None]
) -> list[_Filled]:
    mentions = [place for place in places if place is not None]
    filled = []
    known = set()  # a value that fills several slots is named once, where the first of them is said
    for slot in slots:
        if slot.entity_class and slot.filler is not None and not slot.is_choice:
            value = slot.filler.casefold()
            if value in known:
                continue
            known.add(value)
            mine = tuple(
                place
                for span, place in zip(heard.spans, mentions, strict=True)
                if span.value.casefold() == value
            )
            if mine:
                filled.append(_Filled(slot, role_at(form, slot.path), mine[:MOST_MENTIONS]))
    return filled[:MOST_SLOTS]


def _exchanges(
    filled: Sequence[_Filled], actions: Sequence[str], use: WordUse
) -> Iterator[Exchange]:
    found: set[tuple[int, ...]] = set()
    for one, other in combinations(filled, 2):
        if one.slot.filler == other.slot.filler or one.role.whole == other.role.whole:
            continue
        pair = one.slot.entity_class, other.slot.entity_class
        # "Put the desk on the apple" names a place where a thing stands.
        is_of_both = any(are_alike(each, PLACE) for each in pair) and not _THINGS.isdisjoint(pair)
        if are_alike(*pair) or is_of_both:
            here = _pair(one.places, one.role, other.places, other.role, use)
            nats = _pair(other.places, one.role, one.places, other.role, use) - here
            if nats > (EXCHANGED if are_alike(*pair) else IMPOSSIBLE):
                found |= {one.slot.path, other.slot.path}
                yield Exchange((one.slot, other.slot), nats)
    for each in filled:
        is_goal = each.role.similar == GOAL  # to go there, and to meet somebody there, is the same
        if is_goal or each.slot.path in found or not are_alike(each.slot.entity_class, PLACE):
            continue
        taken = {other.role.similar for other in filled}
        rivals = [
            role
            for role in use.rivals(each.role, each.slot.entity_class, actions)
            if role.similar not in taken
        ]
        here = max(use.score(place, each.role, True) for place in each.places)
        there = (use.score(place, role, True) for role in rivals for place in each.places)
        nats = max(there, default=-inf) - here
        if nats > ELSEWHERE:
            yield Exchange((each.slot,), nats)


def _pair(
    places: Sequence[Place], role: Role, others: Sequence[Place], other: Role, use: WordUse
) -> float:
    """Return the score of two values in two roles, each by the best of its mentions."""
    return max(
        use.score(place, role)
        + use.score(second, other)
        + (use.order(role, other) if place.number < second.number else use.order(other, role))
        for place in places
        for second in others
    )
