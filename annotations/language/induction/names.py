"""What else a thing may be called: "Dr Brandt" and "Brandt" for "doctor Brandt", "patient Okafor" for a patient."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import pairwise

from annotations.language.induction.classes import MarkedClass, folded
from annotations.language.induction.rules import Rule
from annotations.language.texts import ARTICLES, NUMBERS, TITLE_SPELLINGS, TITLES


def other_names(
    classes: Sequence[MarkedClass],
    known: Collection[str],
    refused: Collection[frozenset[str]],
    rules: Iterable[Rule],
) -> dict[str, tuple[str, ...]]:
    """Return text → what else it may be called, where nothing else is called so.

    Args:
        known: what the entities of the world are called, folded.
        refused: the pairs of names in brackets that are said not to be one.
        rules: commands; where they say the noun of a class before its slot, it is no part of the name.
    """
    pairs = {pair for rule in rules for pair in pairwise(rule.words)}
    nouns = {
        each.token: each.token.replace("_", " ")
        for each in classes
        if each.is_named and (each.token.rpartition("_")[2], f"<{each.token}>") not in pairs
    }
    called = {
        text: tuple(_names(text, nouns.get(each.token, "")))
        for each in classes
        for text in each.texts
    }
    uses = Counter(folded(name) for names in called.values() for name in {*names})
    taken = {*known, *(folded(text) for text in called)}
    return {
        text: tuple(
            name
            for name in dict.fromkeys(names)
            if uses[folded(name)] == 1
            and folded(name) not in taken
            and frozenset((f"[{name}]", f"[{text}]")) not in refused
        )
        for text, names in called.items()
    }


def is_title(word: str) -> bool:
    """Return whether a word stands before the name of a person."""
    return word.rstrip(".").casefold() in TITLES


def _names(text: str, noun: str) -> Iterator[str]:
    first, _, name = text.partition(" ")
    has_title = bool(name) and is_title(first)
    if has_title:
        for title in _spellings(first):
            yield f"{title} {name}"
        yield name
        yield f"{name} the {first}"
    if name and (text.split()[-1].isdigit() or text.split()[-1].lower() in NUMBERS):
        before, _, number = text.rpartition(" ")
        yield f"{before} number {number}"
    # Nobody says "the staff doctor Brandt".
    if noun and first[0].isupper() and _is_name(text) and noun not in text.lower().split():
        yield f"{noun} {text}"
        if has_title:
            yield f"{noun} {name}"


def _spellings(title: str) -> Iterator[str]:
    """Yield how else a title is written, with a point where it is short."""
    plain = title.rstrip(".")
    group = next(
        (each for each in TITLE_SPELLINGS if plain.casefold() in map(str.casefold, each)), ()
    )
    for spelling in (*group, *(f"{each}." for each in group[:1])):
        if spelling.casefold() != title.casefold():
            yield spelling


def _is_name(text: str) -> bool:
    """Return whether a text is the name of one thing: its words begin with capital letters."""
    words = [each for each in text.split() if each.lower() not in ARTICLES]
    return any(each[0].isupper() for each in words) and all(
        each[0].isupper() or is_title(each) for each in words
    )
