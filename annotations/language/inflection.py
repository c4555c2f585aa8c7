"""Plural and singular spellings of English nouns: guesses to recognise words by, never to print."""

from __future__ import annotations

from collections.abc import Iterator

_VOWELS = "aeiou"


def spellings(noun: str) -> Iterator[str]:
    """The other number's likely spellings of a noun phrase, by its last word.

    ``knife`` gives knives, ``dish`` dishes, ``cookies`` cookie and cooky, ``tea spoon`` tea spoons.
    """
    head, space, last = noun.rpartition(" ")
    for spelling in (*_plurals(last), *_singulars(last)):
        if spelling and spelling != last:
            yield f"{head}{space}{spelling}"


def _plurals(word: str) -> Iterator[str]:
    lower = word.lower()
    if lower.endswith(("s", "x", "z", "ch", "sh")):
        yield f"{word}es"
        return
    if lower.endswith("y") and lower[-2:-1] not in _VOWELS:
        yield f"{word[:-1]}ies"
    if lower.endswith("fe"):
        yield f"{word[:-2]}ves"
    elif lower.endswith("f"):
        yield f"{word[:-1]}ves"
    elif lower.endswith("o"):
        yield f"{word}es"
    elif lower.endswith("man"):
        yield f"{word[:-2]}en"
    yield f"{word}s"


def _singulars(word: str) -> Iterator[str]:
    lower = word.lower()
    if len(word) < 4 or not lower.endswith("s") or lower.endswith("ss"):
        return
    if lower.endswith("ies"):
        yield f"{word[:-3]}y"
    if lower.endswith("ves"):
        yield from (f"{word[:-3]}f", f"{word[:-3]}fe")
    if lower.endswith(("ses", "xes", "zes", "ches", "shes", "oes")):
        yield word[:-2]
    yield word[:-1]
