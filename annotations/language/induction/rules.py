"""Rules: the words of a command with slots, and its form; what one rule has where another has something else."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import SequenceMatcher
from functools import lru_cache
from typing import TypeAlias

from annotations.language.forms import (
    Constant,
    Form,
    Nonterminal,
    Text,
    Wildcard,
    with_leaves,
)
from annotations.language.texts import ARTICLES, BOUNDARIES, LIGHT_WORDS, PRONOUNS

Words: TypeAlias = "tuple[str, ...]"

_SAYS_NOTHING = frozenset((*ARTICLES, *BOUNDARIES, *LIGHT_WORDS, *PRONOUNS, "yourself", ","))


REMEMBERED = 1 << 15  # pairs of sequences that were compared


@dataclass(frozen=True, slots=True)
class Rule:
    """Words with slots, such as ``water the <plant>``, and their form.

    Slot n of the words, counted from 1, is the wildcard with the number n in the form. A word may be a nonterminal,
    ``$water``.
    """

    words: Words
    form: Form

    def __str__(self) -> str:
        return " ".join(self.words)


@dataclass(frozen=True, slots=True)
class Difference:
    """Where two rules differ: ``old`` from ``start`` on in the words of the one is ``new`` in those of the other."""

    start: int
    old: Words
    other_start: int
    new: Words


def is_slot(word: str) -> bool:
    return word.startswith("<")


def phrase_symbols(phrase: Words) -> tuple[Text | Nonterminal, ...]:
    """Return the symbols of words without slots."""
    return tuple(Nonterminal(each[1:]) if each.startswith("$") else Text(each) for each in phrase)


def without_articles(words: Words) -> Words:
    return tuple(word for word in words if word.lower() not in ARTICLES)


def articles_varied(words: Words) -> tuple[Words, ...]:
    """Return a command as it is, without articles, and with one before each slot: the oracle passes over them."""
    bare = without_articles(words)
    with_the = tuple(
        each for word in bare for each in (("the", word) if is_slot(word) else (word,))
    )
    return words, bare, with_the


def with_tokens(form: Form) -> Form:
    """Return the form with class tokens for its slots, as commands have them."""
    return with_leaves(
        form, lambda leaf: Constant(f"<{leaf.name}>") if isinstance(leaf, Wildcard) else leaf
    )


def count_slots(words: Iterable[str]) -> int:
    return sum(map(is_slot, words))


def says_something(word: str) -> bool:
    """Return whether a word is a slot, or neither article, preposition, pronoun nor light verb."""
    return word.lower() not in _SAYS_NOTHING


def shared_at_end(left: Words, right: Words) -> int:
    """Return how many words two sequences end with alike."""
    most = min(len(left), len(right))
    return next((n for n in range(most) if left[-1 - n] != right[-1 - n]), most)


def shared_around(left: Words, right: Words) -> int:
    """Return how many words two sequences begin and end with alike, none of them counted twice."""
    start = shared_at_end(left[::-1], right[::-1])
    return start + shared_at_end(left[start:], right[start:])


@lru_cache(maxsize=REMEMBERED)
def differences(left: Words, right: Words) -> tuple[Difference, ...]:
    """Return the places where two sequences differ, in order, around what they share in that order."""
    opcodes = SequenceMatcher(None, left, right, autojunk=False).get_opcodes()
    return tuple(
        Difference(start, left[start:end], other, right[other:other_end])
        for tag, start, end, other, other_end in opcodes
        if tag != "equal"
    )


def slots_shared(left: Words, right: Words) -> dict[int, int]:
    """Return for the slots of ``right`` those of ``left`` that stand in the same places, outside all differences."""
    numbers: dict[int, int] = {}
    blocks = SequenceMatcher(None, left, right, autojunk=False).get_matching_blocks()
    for start, other, length in blocks:
        mine, its = count_slots(left[:start]), count_slots(right[:other])
        shared = count_slots(left[start : start + length])
        numbers |= {its + n: mine + n for n in range(1, shared + 1)}
    return numbers


def renumbered(form: Form, numbers: Mapping[int, int]) -> Form:
    """Return the form with other numbers for its slots; those that ``numbers`` lacks stay."""

    def change(leaf: Form) -> Form:
        if isinstance(leaf, Wildcard) and leaf.id is not None:
            return Wildcard(leaf.name, id=numbers.get(leaf.id, leaf.id))
        return leaf

    return with_leaves(form, change)


def least_difference(left: Counter[str], right: Counter[str]) -> int:
    """Return how many words two sequences with these counts differ in at least."""
    return (left - right).total() + (right - left).total()


def mean_the_same(left: Rule, right: Rule) -> bool:
    """Return whether two rules have one form, up to the numbers of the slots that stand in the same places."""
    if count_slots(left.words) != count_slots(right.words):
        return False
    shared = slots_shared(left.words, right.words)
    return len(shared) == count_slots(right.words) and left.form == renumbered(right.form, shared)
