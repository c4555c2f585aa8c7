"""Words that vary: phrases that stand in one place of commands with one form become a nonterminal.

That phrases which share a context may stand for each other is the hypothesis of alignment-based learning (van Zaanen,
"ABL: Alignment-Based Learning", COLING 2000). Here the forms have to be equal as well, which is what makes the
grammar synchronous (Wong and Mooney, "Learning for semantic parsing with statistical machine translation", NAACL
2006).
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from annotations.language.forms import Unknown, head_predicate
from annotations.language.induction.rules import (
    Difference,
    Rule,
    Words,
    count_slots,
    differences,
    is_slot,
    least_difference,
    mean_the_same,
    says_something,
)

ROUNDS = 20
MOST_DIFFERENCES = 3
MOST_COMPARED = 5_000  # pairs of rules a round
# Groups of phrases of different predicates are one if they share as many phrases.
SHARED_PHRASES = 2


@dataclass(frozen=True, slots=True)
class Synonyms:
    """``$name = phrase | phrase``.

    ``heads`` are the predicates in whose commands the phrases were seen to mean the same; ``holds_everywhere`` says
    that they may be taken to mean the same in those of other predicates, too.
    """

    name: str
    phrases: tuple[Words, ...]
    heads: frozenset[str]
    holds_everywhere: bool

    def holds_for(self, rule: Rule) -> bool:
        """Return whether the phrases may stand for each other in a rule."""
        return self.holds_everywhere or head_predicate(rule.form) in self.heads


def find_synonyms(rules: Sequence[Rule]) -> tuple[tuple[Rule, ...], tuple[Synonyms, ...]]:
    """Return the rules with nonterminals for the words that vary, equal ones once, and what the nonterminals become.

    The smallest differences count first: what they show is the same in what differs in more.
    """
    pairs: dict[tuple[str, Words, Words], None] = {}
    found: tuple[Synonyms, ...] = ()
    written = tuple(dict.fromkeys(rules))
    for _ in range(ROUNDS):
        first = {f"${each.name}": each.phrases[0] for each in found}
        more = {
            (head, _plain(old, first), _plain(new, first)): None
            for head, old, new in _smallest(written)
        }
        if more.keys() <= pairs.keys():
            break
        pairs |= more
        found = _grouped(pairs)
        written = tuple(dict.fromkeys(with_nonterminals(rule, found) for rule in rules))
    return written, found


def with_nonterminals(rule: Rule, synonyms: Iterable[Synonyms]) -> Rule:
    """Return the rule with a nonterminal for each phrase that may vary in it, longer phrases first."""
    words = rule.words
    fitting = [
        (phrase, each) for each in synonyms if each.holds_for(rule) for phrase in each.phrases
    ]
    for phrase, each in sorted(fitting, key=lambda item: -len(item[0])):
        place = 0
        while place + len(phrase) <= len(words):
            if words[place : place + len(phrase)] == phrase:
                words = (*words[:place], f"${each.name}", *words[place + len(phrase) :])
            place += 1
    return Rule(words, rule.form)


def _smallest(rules: Sequence[Rule]) -> list[tuple[str, Words, Words]]:
    """Return the smallest differences between rules with one form, each with the predicate that heads it."""
    by_shape: defaultdict[tuple[str, int], list[Rule]] = defaultdict(list)
    for rule in rules:
        if not isinstance(rule.form, Unknown):
            by_shape[head_predicate(rule.form), count_slots(rule.words)].append(rule)
    counts = {rule.words: Counter(rule.words) for rule in rules}
    pairs = [
        (least_difference(counts[left.words], counts[right.words]), number, left, right)
        for number, (left, right) in enumerate(
            pair for alike in by_shape.values() for pair in combinations(alike, 2)
        )
    ]
    smallest: dict[int, list[tuple[int, Rule, tuple[Difference, ...]]]] = {}
    for least, number, left, right in sorted(pairs, key=lambda each: each[:2])[:MOST_COMPARED]:
        if smallest and least > min(smallest):
            break
        if mean_the_same(left, right):
            found = differences(left.words, right.words)
            if len(found) <= MOST_DIFFERENCES and all(
                _may_vary(each.old) and _may_vary(each.new) for each in found
            ):
                size = sum(len(each.old) + len(each.new) for each in found)
                smallest.setdefault(size, []).append((number, left, found))
    chosen = sorted(smallest[min(smallest)], key=lambda each: each[0]) if smallest else []
    return [
        (head_predicate(rule.form), each.old, each.new)
        for _, rule, found in chosen
        for each in found
    ]


def _plain(phrase: Words, first: Mapping[str, Words]) -> Words:
    """Return the phrase with a phrase of its own for each nonterminal."""
    return tuple(word for each in phrase for word in first.get(each, (each,)))


def _may_vary(phrase: Words) -> bool:
    return not any(map(is_slot, phrase)) and any(map(says_something, phrase))


def _grouped(pairs: Iterable[tuple[str, Words, Words]]) -> tuple[Synonyms, ...]:
    """Return the phrases that mean the same, directly or through others, predicate by predicate."""
    groups: list[tuple[dict[Words, None], set[str]]] = []
    for head, old, new in pairs:
        mine = [each for each in groups if head in each[1] and each[0].keys() & {old, new}]
        phrases = dict.fromkeys(phrase for each in mine for phrase in each[0]) | {
            old: None,
            new: None,
        }
        groups = [each for each in groups if each not in mine] + [(phrases, {head})]
    joined: list[tuple[dict[Words, None], set[str]]] = []
    for phrases, heads in groups:
        same = [each for each in joined if len(each[0].keys() & phrases.keys()) >= SHARED_PHRASES]
        for each in same:
            phrases, heads = each[0] | phrases, each[1] | heads
        joined = [each for each in joined if each not in same] + [(phrases, heads)]
    used = Counter(phrase for phrases, _ in joined for phrase in phrases)
    names = _names(phrases for phrases, _ in joined)
    return tuple(
        Synonyms(
            *(name, tuple(phrases), frozenset(heads)),
            holds_everywhere=len(heads) > 1 and all(used[phrase] == 1 for phrase in phrases),
        )
        for name, (phrases, heads) in zip(names, joined, strict=True)
    )


def _names(groups: Iterable[Iterable[Words]]) -> Iterator[str]:
    """Yield a name for each group of phrases, after the first word that says something."""
    taken: set[str] = set()
    for phrases in groups:
        name = free_name([word for phrase in phrases for word in phrase], taken)
        taken.add(name)
        yield name


def free_name(words: Iterable[str], taken: Collection[str]) -> str:
    """Return a name for a nonterminal, after the first word that says something."""
    saying = (word for word in words if says_something(word))
    name = re.sub(r"[^a-z]", "", next(saying, "").lower()) or "words"
    if name in taken:
        name = next(each for n in range(2, 100_000) if (each := f"{name}{n}") not in taken)
    return name
