"""Find what an utterance joins with "or": alternatives, of which one is meant and nobody has said which."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from annotations.language.english import (
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
from annotations.language.grounding.anonymizer import Anonymized

_WORD = re.compile(r"[^\W_][\w'’-]*|[^\w\s]")
_LEADING = PLACE_PREPOSITIONS | CHOICE_FILLERS
_NO_PART = BOUNDARIES | DETERMINERS | VAGUE_WORDS
_OBJECTS = DETERMINERS | PERSON_WORDS | THING_WORDS | {"me", "us"}  # what follows a verb
_MOST_MODIFIERS = 2
_LONGEST = 4  # words of a name that nobody knows
_ALIKE = (frozenset(("location", "room")), frozenset(("object", "category")))

# A member of a choice: the number of a span, or words that nothing explains.
_Member = int | str


@dataclass(frozen=True, slots=True)
class Alternatives:
    """``spans`` are the numbers of the spans that "or" joins, in order; ``phrases`` unknown words among them."""

    spans: tuple[int, ...]
    phrases: tuple[str, ...] = ()


def find_alternatives(anonymized: Anonymized) -> tuple[Alternatives, ...]:
    """Return the choices that an utterance leaves: "the tea or the knife", "either Bo, Ada or Cy".

    Members are of one class, or of two that stand in the same places (location and room, object and
    category). Other entities that belong to a member may stand between: "the tea from the shelf or
    the knife". A choice has a span at least; words that nothing explains may be the rest of it.
    """
    groups: list[list[_Member]] = []
    for members in _Reader(anonymized).choices():
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


class _Reader:
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
        if not phrase or (not is_named and not self._is_closed(phrase, beyond)):
            return None
        return " ".join(phrase)

    def _is_closed(self, phrase: Sequence[str], beyond: int) -> bool:
        """Return whether words without an article may be a name rather than a verb and what it is done to."""
        if phrase[0].casefold() in GOING_WORDS or len(phrase) > _MOST_MODIFIERS:
            return False
        return beyond == len(self._words) or self._words[beyond] not in _OBJECTS

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
            comma = self._begin(place) - 1
            before = comma - 1
            if before < 0 or self._words[comma] != ",":
                return listed[::-1]
            item = self._items[before]
            if not isinstance(item, int) or not self._go_together(item, member):
                return listed[::-1]
            listed.append(item)
            place = before

    def _begin(self, place: int) -> int:
        """Return where the noun phrase of the item at ``place`` begins."""
        begin = place
        modifiers = self._unexplained_before(place - 1)[-_MOST_MODIFIERS:] if place else []
        article = place - len(modifiers) - 1
        if article >= 0 and self._words[article] in DETERMINERS:
            begin = article
        return begin - 1 if begin and self._words[begin - 1] in _LEADING else begin

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
