"""What an utterance says about the slots of any form: found once for all forms that a parser gives."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile

from annotations.language.forms import (
    KIND_CLASS,
    PERSON_CLASS,
    PLACE_CLASSES,
    THING_CLASS,
)
from annotations.language.grounding.anonymizer import Anonymized, Span
from annotations.language.grounding.assignment import Mention
from annotations.language.grounding.roles import Context, context_of, words_of
from annotations.language.texts import (
    BOUNDARIES,
    CHOICE_FILLERS,
    CHOOSING_WORDS,
    DETERMINERS,
    GOING_WORDS,
    PERSON_WORDS,
    PLACE_PREPOSITIONS,
    THING_WORDS,
    VAGUE_WORDS,
)
from annotations.language.world import Ontology

# A member of a choice: the number of a span, or words that nothing explains.
_Member = int | str

_WORD = re.compile(r"[^\W_][\w'’-]*|[^\w\s]")
_WORD_OR_TOKEN = re.compile(rf"<\w+>|{_WORD.pattern}")
_LEADING = PLACE_PREPOSITIONS | CHOICE_FILLERS
_NO_PART = BOUNDARIES | DETERMINERS | VAGUE_WORDS
_OBJECTS = DETERMINERS | PERSON_WORDS | THING_WORDS | {"me", "us"}  # what follows a verb
_MOST_MODIFIERS = 2
_LONGEST = 4  # words of a name that nobody knows
_ALIKE = (PLACE_CLASSES, frozenset((THING_CLASS, KIND_CLASS)))
_NO_NAMES = frozenset((*BOUNDARIES, *DETERMINERS, *PERSON_WORDS, *THING_WORDS))


class UtteranceMentions:
    """The mentions of an utterance, and the ``phrases`` that may name an entity (``unknown_phrases``)."""

    def __init__(self, anonymized: Anonymized, ontology: Ontology) -> None:
        self.phrases = unknown_phrases(anonymized, ontology)
        self._spans = anonymized.spans
        self._contexts = _contexts(anonymized)
        self._joined = find_alternatives(anonymized)
        self._mentions: dict[tuple[str, frozenset[str] | None], tuple[Mention, ...]] = {}

    def spans(self, entity_class: str) -> list[Span]:
        """Return the spans of a class."""
        return [span for span in self._spans if span.entity_class == entity_class]

    def mentions(self, entity_class: str, others: frozenset[str] | None) -> tuple[Mention, ...]:
        """Return the mentions of a class with their contexts in the anonymized utterance.

        What "or" joins is one mention, in the place of the first one of the class. ``others`` are the classes of other
        slots of the form, which take members of theirs; None where "or" joins nothing in this form.
        """
        key = entity_class, others if self._joined else None
        if key in self._mentions:
            return self._mentions[key]
        mentions: list[Mention] = []
        seen: list[Span] = []
        for number, span in enumerate(self._spans):
            if span.entity_class != entity_class or span in seen:
                continue
            members, phrases = self._members(number, key[1])
            seen += members
            values = tuple(dict.fromkeys(each.value for each in members))
            is_choice = len(values) + len(phrases) > 1
            entities = tuple(each for member in members for each in (member.entity, *member.others))
            mentions.append(
                Mention(
                    span.value,
                    self._contexts[number],
                    entities,
                    values if is_choice else (),
                    phrases if is_choice else (),
                )
            )
        self._mentions[key] = tuple(mentions)
        return self._mentions[key]

    def _members(
        self, number: int, others: frozenset[str] | None
    ) -> tuple[list[Span], tuple[str, ...]]:
        """Return the spans and the unknown words of which one is meant where span ``number`` stands."""
        span = self._spans[number]
        group = next((each for each in self._joined if number in each.spans), None)
        if group is None or others is None:
            return [span], ()

        def fits(other: Span) -> bool:
            is_mine = other.entity_class == span.entity_class
            is_free = other.entity_class not in others
            return is_mine or (is_free and are_alike(other.entity_class, span.entity_class))

        spans = [self._spans[each] for each in group.spans]
        return [each for each in spans if fits(each)], group.phrases


def _contexts(anonymized: Anonymized) -> list[Context]:
    """Return how each span stands in the anonymized utterance."""
    words: list[str] = []
    places: list[int] = []
    end = 0
    for span in anonymized.spans:
        words += words_of(anonymized.original[end : span.start])
        places.append(len(words))
        words.append(f"<{span.entity_class}>")
        end = span.end
    words += words_of(anonymized.original[end:])
    return [context_of(words, place) for place in places]


@dataclass(frozen=True, slots=True)
class Alternatives:
    """``spans`` are the numbers of the spans that "or" joins, in order; ``phrases`` unknown words among them."""

    spans: tuple[int, ...]
    phrases: tuple[str, ...] = ()


def find_alternatives(anonymized: Anonymized) -> tuple[Alternatives, ...]:
    """Return the choices that an utterance leaves: "the tea or the knife", "either Bo, Ada or Cy".

    Members are of one class, or of two that stand in the same places (location and room, object and
    category). Other entities that belong to a member may stand between: "the tea from the shelf or
    the knife". At least one member is a span; the others may be words that nothing explains.
    """
    groups: list[list[_Member]] = []
    for members in _ChoiceReader(anonymized).choices():
        earlier = next((group for group in groups if set(group) & set(members)), None)
        if earlier is None:
            groups.append(list(members))
        else:
            earlier += [each for each in members if each not in earlier]
    return tuple(
        Alternatives(
            tuple(sorted(each for each in group if isinstance(each, int))),
            tuple(each for each in group if isinstance(each, str)),
        )
        for group in groups
    )


def are_alike(one: str, other: str) -> bool:
    """Return whether entities of two classes stand in the same places."""
    return one == other or any({one, other} <= classes for classes in _ALIKE)


class _ChoiceReader:
    """Reads noun phrases before and after an "or". ``items`` are words, and numbers of spans."""

    def __init__(self, anonymized: Anonymized) -> None:
        self._classes = [span.entity_class for span in anonymized.spans]
        self._items: list[_Member] = []
        end = 0
        for number, span in enumerate(anonymized.spans):
            self._items += _WORD.findall(anonymized.original[end : span.start])
            self._items.append(number)
            end = span.end
        self._items += _WORD.findall(anonymized.original[end:])
        self._words = [each.casefold() if isinstance(each, str) else "" for each in self._items]

    def choices(self) -> Iterator[list[_Member]]:
        """Yield the members of each "or" in the order of the text."""
        for at, word in enumerate(self._words):
            last = self._after(at + 1) if word in CHOOSING_WORDS else None
            if last is None:
                continue
            end = at - 1 if at and self._words[at - 1] == "," else at
            before = self._before(end, last)
            if before is not None:
                place, member = before
                yield [*self._listed_before(place, member), member, last]

    def _after(self, at: int) -> _Member | None:
        """Return what a noun phrase from ``at`` on names."""
        while at < len(self._words) and self._words[at] in _LEADING | DETERMINERS:
            at += 1
        phrase = self._unexplained(self._items[at : at + _LONGEST])
        beyond = at + len(phrase)
        member = self._items[beyond] if beyond < len(self._items) else ""
        if isinstance(member, int) and len(phrase) <= _MOST_MODIFIERS:
            return member
        is_named = at > 0 and self._words[at - 1] in DETERMINERS
        if not phrase or is_named:
            return " ".join(phrase) or None
        # Without an article the words may be a verb and what it is done to.
        if phrase[0].casefold() in GOING_WORDS or len(phrase) > _MOST_MODIFIERS:
            return None
        is_closed = beyond == len(self._words) or self._words[beyond] not in _OBJECTS
        return " ".join(phrase) if is_closed else None

    def _before(self, end: int, last: _Member) -> tuple[int, _Member] | None:
        """Return the place and the member of the noun phrase before ``end`` that goes with ``last``."""
        at = end - 1
        while at >= 0:
            item = self._items[at]
            if isinstance(item, int):
                if self._go_together(item, last):
                    return at, item
                at -= 1
            elif self._words[at] in _LEADING | DETERMINERS:
                at -= 1
            else:
                phrase = self._unexplained_before(at)
                begin = at - len(phrase)  # of the article
                if not phrase or begin < 0 or self._words[begin] not in DETERMINERS:
                    return None
                if begin and self._words[begin - 1] in _LEADING:
                    at = begin - 1
                    continue
                return (begin, " ".join(phrase)) if isinstance(last, int) else None
        return None

    def _listed_before(self, place: int, member: _Member) -> list[_Member]:
        """Return the members that commas separate from the one at ``place``, the first one first."""
        listed: list[_Member] = []
        while True:
            begin = place  # of its noun phrase
            modifiers = self._unexplained_before(place - 1)[-_MOST_MODIFIERS:] if place else []
            article = place - len(modifiers) - 1
            if article >= 0 and self._words[article] in DETERMINERS:
                begin = article
            comma = (begin - 1 if begin and self._words[begin - 1] in _LEADING else begin) - 1
            before = comma - 1
            if before < 0 or self._words[comma] != ",":
                return listed[::-1]
            item = self._items[before]
            if not isinstance(item, int) or not self._go_together(item, member):
                return listed[::-1]
            listed.append(item)
            place = before

    def _go_together(self, number: int, other: _Member) -> bool:
        return isinstance(other, str) or are_alike(self._classes[number], self._classes[other])

    def _unexplained(self, items: Sequence[_Member]) -> list[str]:
        """Return the words that ``items`` begin with and that a name may contain."""
        words: list[str] = []
        for item in items:
            if isinstance(item, int) or item.casefold() in _NO_PART or not item[0].isalnum():
                break
            words.append(item)
        return words

    def _unexplained_before(self, at: int) -> list[str]:
        """Return the words up to the one at ``at`` that a name may contain."""
        items = self._items[max(0, at - _LONGEST + 1) : at + 1]
        return self._unexplained(items[::-1])[::-1]


def unknown_phrases(anonymized: Anonymized, ontology: Ontology) -> Mapping[str, tuple[str, ...]]:
    """Return the phrases that may name an entity, by class; the key ``""`` has all of them.

    A phrase stands after an article or another determiner and ends before a word that no name contains:
    "flurb" in "bring me the flurb from the shelf". Words with a capital inside the utterance are a
    phrase too; a name is one of those, a location or a room one after a preposition of place, an object or a category
    one elsewhere. Where there is none of its kind, every phrase may be meant.
    """
    found = list(_find(anonymized))
    phrases = tuple(dict.fromkeys(phrase for phrase, _, _ in found))
    places = [phrase for phrase, is_place, _ in found if is_place]
    names = [phrase for phrase, _, is_name in found if is_name]
    things = [phrase for phrase, is_place, is_name in found if not is_place and not is_name]
    kinds = {PERSON_CLASS: names}
    kinds |= dict.fromkeys(PLACE_CLASSES, places)
    kinds |= dict.fromkeys((THING_CLASS, KIND_CLASS), things)
    return {"": phrases} | {each: tuple(dict.fromkeys(of)) or phrases for each, of in kinds.items()}


def _find(anonymized: Anonymized) -> Iterator[tuple[str, bool, bool]]:
    """Yield each phrase, whether it follows a preposition of place, whether it has capitals."""
    gaps: list[tuple[int, int]] = []
    end = 0
    for span in anonymized.spans:
        gaps.append((end, span.start))
        end = span.end
    gaps.append((end, len(anonymized.original)))
    for start, stop in gaps:
        words = _WORD_OR_TOKEN.findall(anonymized.original[start:stop])
        at = 0
        while at < len(words):
            word = words[at]
            is_determiner = word.casefold() in DETERMINERS
            is_name = _is_capitalised(word) and not (start == at == 0)
            first = at + 1 if is_determiner else at
            following = words[first : first + _LONGEST] if is_determiner or is_name else []
            phrase = list(
                takewhile(
                    lambda each: each.casefold() not in _NO_NAMES and each[0].isalnum(), following
                )
            )
            if phrase:
                before = words[at - 1].casefold() if at else ""
                yield " ".join(phrase), before in PLACE_PREPOSITIONS, _is_capitalised(phrase[0])
            at = max(at + 1, first + len(phrase))


def _is_capitalised(word: str) -> bool:
    return word[0].isupper() and word != "I" and word.casefold() not in _NO_NAMES
