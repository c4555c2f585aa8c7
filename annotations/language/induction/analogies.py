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
    slots_shared,
)
from annotations.language.templates import solve_analogy
from annotations.language.world import check_form, infer_signatures

MOST_DERIVED = 500
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

    None is there already, and none uses a predicate with other kinds of arguments than the rules do.
    """
    known = {rule.words: canonicalize(rule.form) for rule in rules}
    declared = infer_signatures(rule.form for rule in rules)
    exchanges: defaultdict[tuple[Words, Words], list[_Pair]] = defaultdict(list)
    for left, right in _neighbours(rules):
        found = differences(left.words, right.words)
        if len(found) == 1 and _is_small(left, right, found[0]):
            exchanges[found[0].old, found[0].new].append((left, right, found[0]))
    derived: dict[Words, Derived] = {}
    for (old, new), pairs in exchanges.items():
        for each in _exchanged(rules, old, new, pairs, known):
            if check_form(each.rule.form, declared):
                continue
            best = derived.get(each.rule.words)
            if best is None or len(best.examples) < len(each.examples):
                derived[each.rule.words] = each
    return tuple(sorted(derived.values(), key=lambda each: -len(each.examples))[:MOST_DERIVED])


def _neighbours(rules: Sequence[Rule]) -> Iterator[tuple[Rule, Rule]]:
    """Yield the pairs of rules, in both orders, that begin or end alike."""
    groups: defaultdict[tuple[bool, str], list[Rule]] = defaultdict(list)
    for rule in rules:
        groups[True, rule.words[0]].append(rule)
        groups[False, rule.words[-1]].append(rule)
    pairs = ((left, right) for group in groups.values() for left in group for right in group)
    yield from dict.fromkeys((left, right) for left, right in pairs if left.words != right.words)


def _is_small(left: Rule, right: Rule, found: Difference) -> bool:
    """Return whether the rules share something that says something, and no less than they differ in."""
    shared = (*left.words[: found.start], *left.words[found.start + len(found.old) :])
    longest = max(len(found.old), len(found.new))
    return longest <= len(shared) and any(map(says_something, shared))


def _exchanged(
    rules: Sequence[Rule],
    old: Words,
    new: Words,
    pairs: Sequence[_Pair],
    known: Mapping[Words, Form],
) -> Iterator[Derived]:
    """Yield what an exchange makes of the rules; nothing where more rules contradict it than show it."""
    found: list[Derived] = []
    contradictions = 0
    for source in rules:
        for place in _places(source.words, old, pairs):
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


def _places(words: Words, part: Words, pairs: Sequence[_Pair]) -> Iterator[int]:
    """Yield where a rule has what the pairs exchange; what says nothing only between the same words as there."""
    is_bound = not any(map(says_something, part))
    around = {_around(pair[0].words, pair[2].start, len(part)) for pair in pairs if is_bound}
    for place in range(len(words) - len(part) + 1):
        if words[place : place + len(part)] == part and (
            not is_bound or _around(words, place, len(part)) in around
        ):
            yield place


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
