"""Understand more than what was said: what changes from one command to another changes in a third.

A proportional analogy over pairs of words and form (Lepage, "Solving analogies on words: an algorithm", COLING
1998): where two rules differ in one place, what stands there is exchanged in others, and their forms change as the two
forms differ. Fragments that share a context are exchanged in the same way to make training data (Andreas,
"Good-enough compositional data augmentation", ACL 2020). Here the form has to follow, and no rule may contradict.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import TypeAlias

from annotations.language.forms import Form, Wildcard, canonicalize, walk
from annotations.language.induction.rules import (
    Difference,
    Rule,
    Words,
    count_slots,
    differences,
    renumbered,
    says_something,
    shared_around,
    slots_shared,
)
from annotations.language.templates import solve_analogy
from annotations.language.world import check_form, infer_signatures

MOST_DERIVED = 500
MOST_COMPARED = 20_000  # pairs of rules; those of 200 lines of a household are some hundreds
MOST_SOLVED = 20_000  # analogies that are solved
# Numbers of slots while an analogy is solved: of what the exchange brings, and of the rules that show it.
_BROUGHT, _OTHERS = 1_000, 2_000

_Pair: TypeAlias = "tuple[Rule, Rule, Difference]"


@dataclass(frozen=True, slots=True)
class Derived:
    """A rule that nobody has said: ``source`` with ``old`` exchanged for ``new``.

    ``examples`` are the pairs of rules that show what the exchange means. ``is_sure`` says that there are at least
    two of them.
    """

    rule: Rule
    source: Rule
    old: Words
    new: Words
    examples: tuple[tuple[Rule, Rule], ...]

    @property
    def is_sure(self) -> bool:
        return len(self.examples) > 1


def derive(rules: Sequence[Rule]) -> tuple[Derived, ...]:
    """Return at most ``MOST_DERIVED`` rules that follow from others, sure ones first.

    None is there already, and none uses a predicate with other kinds of arguments than the rules do. Of very many rules
    that differ in little, not all are compared.
    """
    known = {rule.words: canonicalize(rule.form) for rule in rules}
    declared = infer_signatures(rule.form for rule in rules)
    exchanges: defaultdict[tuple[Words, Words], list[_Pair]] = defaultdict(list)
    for left, right in islice(_neighbours(rules), MOST_COMPARED):
        found = differences(left.words, right.words)
        if len(found) == 1 and _is_small(left, right, found[0]):
            exchanges[found[0].old, found[0].new].append((left, right, found[0]))
    derived: dict[Words, Derived] = {}
    places, left_to_solve = _Places(rules), MOST_SOLVED
    for (old, new), pairs in exchanges.items():
        sources = places.of(old, pairs)
        left_to_solve -= len(sources) * len(pairs)
        if left_to_solve < 0:
            break
        for each in _exchanged(sources, old, new, pairs, known):
            if check_form(each.rule.form, declared):
                continue
            best = derived.get(each.rule.words)
            if best is None or len(best.examples) < len(each.examples):
                derived[each.rule.words] = each
    return tuple(sorted(derived.values(), key=lambda each: -len(each.examples))[:MOST_DERIVED])


def _neighbours(rules: Sequence[Rule]) -> Iterator[tuple[Rule, Rule]]:
    """Yield the pairs of rules, in both orders, that begin or end alike and may differ in one small place."""
    groups: defaultdict[tuple[bool, str], list[Rule]] = defaultdict(list)
    for rule in rules:
        groups[True, rule.words[0]].append(rule)
        groups[False, rule.words[-1]].append(rule)
    pairs = ((left, right) for group in groups.values() for left in group for right in group)
    seen: set[tuple[int, int]] = set()
    for left, right in pairs:
        key = (id(left), id(right))
        if key not in seen and left.words != right.words:
            seen.add(key)
            if 2 * shared_around(left.words, right.words) >= max(
                map(len, (left.words, right.words))
            ):
                yield left, right


def _is_small(left: Rule, right: Rule, found: Difference) -> bool:
    """Return whether the rules share something that says something, and no less than they differ in."""
    shared = (*left.words[: found.start], *left.words[found.start + len(found.old) :])
    longest = max(len(found.old), len(found.new))
    return longest <= len(shared) and any(map(says_something, shared))


def _exchanged(
    sources: Sequence[tuple[Rule, int]],
    old: Words,
    new: Words,
    pairs: Sequence[_Pair],
    known: Mapping[Words, Form],
) -> Iterator[Derived]:
    """Yield what an exchange makes of rules at some places; nothing where more contradict it than show it."""
    found: list[Derived] = []
    contradictions = 0
    for source, place in sources:
        words = (*source.words[:place], *new, *source.words[place + len(old) :])
        votes: defaultdict[Form, list[_Pair]] = defaultdict(list)
        for pair in pairs:
            form = None if pair[0] is source else _solve(pair, source, place)
            if form is not None:
                votes[canonicalize(form)].append(pair)
        if votes:
            form, agreeing = max(votes.items(), key=lambda item: len(item[1]))
            contradictions += known.get(words, form) != form
            if words not in known:
                examples = tuple(pair[:2] for pair in agreeing)
                found.append(Derived(Rule(words, form), source, old, new, examples))
    if contradictions < len(pairs):
        yield from found


class _Places:
    """Where the words of some rules stand, so that an exchange looks at these alone."""

    def __init__(self, rules: Sequence[Rule]) -> None:
        self._rules = rules
        self._of: defaultdict[str, list[tuple[int, int]]] = defaultdict(list)
        for index, rule in enumerate(rules):
            for place, word in enumerate(rule.words):
                self._of[word].append((index, place))

    def of(self, part: Words, pairs: Sequence[_Pair]) -> list[tuple[Rule, int]]:
        """Return the rules that have what some pairs exchange, each with the place, in order.

        What says nothing counts only between the same words as in a pair.
        """
        if any(map(says_something, part)):
            places = {each for each in self._of[part[0]] if self._stands(part, *each)}
        else:
            around = {_around(pair[0].words, pair[2].start, len(part)) for pair in pairs}
            places = {
                (index, place)
                for before, after in around
                for index, place in (
                    ((index, place + 1) for index, place in self._of[before[0]])
                    if before
                    else ((index, place - len(part)) for index, place in self._of[after[0]])
                )
                if place >= 0
                and self._stands(part, index, place)
                and _around(self._rules[index].words, place, len(part)) == (before, after)
            }
        return [(self._rules[index], place) for index, place in sorted(places)]

    def _stands(self, part: Words, index: int, place: int) -> bool:
        return self._rules[index].words[place : place + len(part)] == part


def _around(words: Words, start: int, length: int) -> tuple[Words, Words]:
    return words[max(0, start - 1) : start], words[start + length : start + length + 1]


def _solve(pair: _Pair, source: Rule, place: int) -> Form | None:
    """Return the form of ``source`` with the exchange of ``pair`` made at ``place``; None if there is none."""
    left, right, found = pair
    before, olds, news = (
        count_slots(source.words[:place]),
        count_slots(found.old),
        count_slots(found.new),
    )
    first = count_slots(left.words[: found.start])
    total = count_slots(left.words)
    of_left = {n: n + _OTHERS for n in range(1, total + 1)}
    of_left |= {first + n: before + n for n in range(1, olds + 1)}
    of_right = {n: of_left[m] for n, m in slots_shared(left.words, right.words).items()}
    of_right |= {first + n: _BROUGHT + n for n in range(1, news + 1)}
    was, becomes = renumbered(left.form, of_left), renumbered(right.form, of_right)
    form = solve_analogy(was, becomes, source.form)
    if form is None or (form == source.form and was != becomes):
        return None
    numbers = {_BROUGHT + n: before + n for n in range(1, news + 1)}
    numbers |= {n: n for n in range(1, before + 1)}
    last = count_slots(source.words)
    numbers |= {n: n - olds + news for n in range(before + olds + 1, last + 1)}
    used = {each.id for each in walk(form) if isinstance(each, Wildcard)}
    return renumbered(form, numbers) if used <= numbers.keys() else None
