"""What people may say as well: offered as further examples, and taken only by a person.

Another order of the words follows from English grammar, other words from the list of how people reword glosses, and
analogies from a single pair of commands.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import islice, pairwise
from typing import TypeAlias

from annotations.language.forms import (
    Constant,
    Form,
    Wildcard,
    head_predicate,
    with_leaves,
)
from annotations.language.induction.actions import ROLE_WORDS, SHIFTING_PARTICLES
from annotations.language.induction.analogies import Derived
from annotations.language.induction.marked_lines import Example, Mark
from annotations.language.induction.rules import Rule, Words, is_slot, renumbered
from annotations.language.texts import DETERMINERS, REWORDED_PATTERNS

MOST_OF_A_RULE = 3  # of each kind
_IN_FRONT = frozenset(("in", "on", "at", "near", "from"))
_POSSESSIVES = ("his", "her", "their")

_Span: TypeAlias = "tuple[int, int]"


class OfferKind(StrEnum):
    """ORDER: the same words in another order; WORDING: other words; ANALOGY: as another pair of commands differs."""

    ORDER = "order"
    WORDING = "wording"
    ANALOGY = "analogy"


@dataclass(frozen=True, slots=True)
class Offer:
    """A line that would be one more example, after ``source``."""

    line: str
    kind: OfferKind
    predicate: str
    source: Rule


def offers_for(
    rules: Sequence[Rule], derived: Iterable[Derived], texts: Mapping[str, Sequence[Mark]]
) -> tuple[Offer, ...]:
    """Return what may be said besides ``rules``; ``texts`` has marks for the entities of each class token."""
    said = {rule.words for rule in rules}
    verbs = {rule.words[0]: head_predicate(rule.form) for rule in rules}
    found: dict[Words, Offer] = {}
    kinds: tuple[tuple[OfferKind, Callable[[Rule], Iterator[Rule]]], ...] = (
        (OfferKind.ORDER, _in_other_orders),
        (OfferKind.WORDING, lambda rule: _in_other_words(rule, verbs)),
    )
    for kind, variants in kinds:
        for rule in rules:
            new = (each for each in variants(rule) if each.words not in said | found.keys())
            for each in islice(new, MOST_OF_A_RULE):
                found[each.words] = _offer(each, kind, rule, texts)
    for analogy in derived:
        if not analogy.is_sure and analogy.rule.words not in said | found.keys():
            found[analogy.rule.words] = _offer(
                analogy.rule, OfferKind.ANALOGY, analogy.source, texts
            )
    return tuple(found.values())


def _offer(rule: Rule, kind: OfferKind, source: Rule, texts: Mapping[str, Sequence[Mark]]) -> Offer:
    number = 0
    parts: list[str | Mark] = []
    filled: dict[int, str] = {}
    used: defaultdict[str, int] = defaultdict(int)
    for word in rule.words:
        if not is_slot(word):
            parts.append(word)
            continue
        number += 1
        token = word[1:-1]
        mark = texts[token][used[token] % len(texts[token])]
        used[token] += 1
        filled[number] = mark.text
        parts.append(mark)
    example = Example(tuple(parts), form=_with_texts(rule.form, filled))
    return Offer(str(example), kind, head_predicate(rule.form), source)


def _with_texts(form: Form, texts: Mapping[int, str]) -> Form:
    def change(leaf: Form) -> Form:
        if isinstance(leaf, Wildcard) and leaf.id is not None:
            return Constant(texts[leaf.id])
        return leaf

    return with_leaves(form, change)


def _in_other_orders(rule: Rule) -> Iterator[Rule]:
    """Yield the rule with its particle behind its object, and with phrases of place exchanged or in front."""
    words = rule.words
    if len(words) > 2 and words[1] in SHIFTING_PARTICLES:
        first = next((n for n, word in enumerate(words) if is_slot(word)), 0)
        if first and all(word.lower() in DETERMINERS for word in words[2:first]):
            yield _moved(rule, [(0, 1), (2, first + 1), (1, 2), (first + 1, len(words))])
    phrases = _phrases_at_end(words)
    if phrases:
        start, last = phrases[0][0], phrases[-1]
        if len(phrases) > 1 and words[last[0]] != "of":
            yield _moved(rule, [(0, start), *reversed(phrases)])
        if words[last[0]] in _IN_FRONT:
            yield _moved(rule, [last, (0, last[0])], comma=True)


def _phrases_at_end(words: Words) -> list[_Span]:
    """Return the prepositional phrases that a rule ends with."""
    phrases: list[_Span] = []
    end = len(words)
    while end and is_slot(words[end - 1]):
        start = end - 1
        while start and words[start - 1].lower() in DETERMINERS:
            start -= 1
        is_particle = start == 2 and words[1] in SHIFTING_PARTICLES
        if start < 2 or is_particle or words[start - 1].lower() not in ROLE_WORDS:
            break
        phrases.insert(0, (start - 1, end))
        end = start - 1
    return phrases


def _moved(rule: Rule, spans: Sequence[_Span], comma: bool = False) -> Rule:
    """Return the rule with its words in the order of ``spans``; ``comma`` puts one behind the first span."""
    order = [place for start, end in spans for place in range(start, end)]
    slots = [place for place, word in enumerate(rule.words) if is_slot(word)]
    in_order = [place for place in order if place in slots]
    numbers = {slots.index(place) + 1: number for number, place in enumerate(in_order, start=1)}
    words = [rule.words[place] for place in order]
    if comma:
        words.insert(spans[0][1] - spans[0][0], ",")
    return Rule(tuple(words), renumbered(rule.form, numbers))


def _in_other_words(rule: Rule, verbs: Mapping[str, str]) -> Iterator[Rule]:
    """Yield the rule with "his" for "her", and with other verbs that mean the same to service robots."""
    for place, (word, behind) in enumerate(pairwise(rule.words)):
        if word in _POSSESSIVES and is_slot(behind):
            for other in _POSSESSIVES:
                yield Rule((*rule.words[:place], other, *rule.words[place + 1 :]), rule.form)
    for pattern, wordings in REWORDED_PATTERNS.items():
        begins, slot, rest = pattern.partition("{1}")
        old = tuple(begins.split())
        if not slot or not old or rest.strip() or rule.words[: len(old)] != old:
            continue
        left = rule.words[len(old) :]
        if not left or not (is_slot(left[0]) or left[0].lower() in DETERMINERS):
            continue
        for wording in wordings:
            new, slot, rest = wording.partition("{1}")
            words = tuple(new.split())
            is_other = verbs.get(words[0]) if words else ""
            if (
                slot
                and words
                and not rest.strip()
                and is_other in (None, head_predicate(rule.form))
            ):
                yield Rule((*words, *left), rule.form)
