"""Find the words of an utterance that may name something and that the ontology does not have."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from annotations.language.english import (
    BOUNDARIES,
    DETERMINERS,
    PERSON_WORDS,
    PLACE_PREPOSITIONS,
    THING_WORDS,
)
from annotations.language.grounding.anonymizer import Anonymized
from annotations.language.ontology import Ontology

_WORD = re.compile(r"<\w+>|[^\W_][\w'’-]*|[^\w\s]")
_LONGEST = 4  # words of a phrase
_NO_NAMES = frozenset((*BOUNDARIES, *DETERMINERS, *PERSON_WORDS, *THING_WORDS))


def unknown_phrases(anonymized: Anonymized, ontology: Ontology) -> Mapping[str, tuple[str, ...]]:
    """Return the phrases that may name an entity, by class; the key ``""`` has all of them.

    A phrase stands after an article or another determiner and ends before a word that no name contains:
    "flurb" in "bring me the flurb from the shelf". Words with a capital inside the utterance are a
    phrase too; they come first for a name. After a preposition of place a phrase comes first for a location or a
    room, elsewhere for an object.
    """
    found = list(_find(anonymized))
    phrases = tuple(dict.fromkeys(phrase for phrase, _, _ in found))
    places = [phrase for phrase, is_place, _ in found if is_place]
    names = [phrase for phrase, _, is_name in found if is_name]
    things = [phrase for phrase, is_place, is_name in found if not is_place and not is_name]

    def first(preferred: list[str]) -> tuple[str, ...]:
        return tuple(dict.fromkeys((*preferred, *phrases)))

    by_class = {"name": first(names), "location": first(places), "room": first(places)}
    return {"": phrases, **by_class, "object": first(things), "category": first(things)}


def _find(anonymized: Anonymized) -> Iterator[tuple[str, bool, bool]]:
    """Yield each phrase, whether it follows a preposition of place, whether it has capitals."""
    gaps: list[tuple[int, int]] = []
    end = 0
    for span in anonymized.spans:
        gaps.append((end, span.start))
        end = span.end
    gaps.append((end, len(anonymized.original)))
    for start, stop in gaps:
        yield from _find_in(anonymized.original[start:stop], start == 0)


def _find_in(text: str, is_start: bool) -> Iterator[tuple[str, bool, bool]]:
    words = _WORD.findall(text)
    at = 0
    while at < len(words):
        word = words[at]
        is_determiner = word.casefold() in DETERMINERS
        is_name = _is_capitalised(word) and not (is_start and at == 0)
        first = at + 1 if is_determiner else at
        phrase = _phrase(words[first:]) if is_determiner or is_name else ()
        if phrase:
            before = words[at - 1].casefold() if at else ""
            yield " ".join(phrase), before in PLACE_PREPOSITIONS, _is_capitalised(phrase[0])
        at = max(at + 1, first + len(phrase))


def _phrase(words: list[str]) -> tuple[str, ...]:
    """Return the words up to one that no name contains."""
    phrase: list[str] = []
    for word in words[:_LONGEST]:
        if word.casefold() in _NO_NAMES or not word[0].isalnum():
            break
        phrase.append(word)
    return tuple(phrase)


def _is_capitalised(word: str) -> bool:
    return word[0].isupper() and word != "I" and word.casefold() not in _NO_NAMES
