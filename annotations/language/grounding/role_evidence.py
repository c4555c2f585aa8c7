"""What tells which mention of a command fills which slot of its form: learned from pairs.

A pair is a command and its form with the same numbered tokens, ``to the <location0> from the
<location1>``. Two features of each mention are counted for the role of its slot: the word before it
and the kind of thing named last before it. What few pairs say of a role is filled up with what all
pairs say of similar roles (naive Bayes with two levels of additive smoothing).
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache

from annotations.language.forms import (
    Application,
    Constant,
    Form,
    Lambda,
    Symbols,
    Text,
    Wildcard,
    canonical_text,
    children,
    read_form,
)
from annotations.language.grounding.drawing import is_of_type
from annotations.language.grounding.roles import (
    Context,
    SlotPath,
    SlotRole,
    class_of,
    context_of,
    role_of,
    tokens_of,
    words_of,
)
from annotations.language.texts import CHOOSING_WORDS, sample_commands
from annotations.language.world import Entity

_FROM_SIMILAR = 2.0  # pairs that what is known of similar roles counts for
_FROM_NOWHERE = 1.0  # pairs that knowing nothing counts for
_FEATURE_VALUES = 60
_MISFIT = -4.0  # log odds of an entity of a kind that the grammar never has in a role
_NO_COUNTS: Mapping[str, int] = {}
_NO_ORDERS: Mapping[tuple[int, ...], int] = {}


class RoleCounts:
    """How often mentions of each role have which values of a feature."""

    def __init__(self) -> None:
        self._by_role: defaultdict[str, Counter[str]] = defaultdict(Counter)
        self._all: Counter[str] = Counter()

    def add(self, features: Mapping[str, str], role: SlotRole) -> None:
        """Count a mention of this role."""
        seen = [*features, *(f"{name} {value}" for name, value in features.items())]
        for counts in (self._by_role[role.exact], self._by_role[role.similar], self._all):
            counts.update(seen)

    def log_odds(self, feature: str, value: str, role: SlotRole) -> float:
        """Return how much more often than any mention one of this role has this value; 0 for a new value."""
        both = f"{feature} {value}"
        if both not in self._all:
            return 0.0
        anywhere = (self._all[both] + 1) / (self._all[feature] + _FEATURE_VALUES)
        share = anywhere
        for name, weight in ((role.similar, _FROM_NOWHERE), (role.exact, _FROM_SIMILAR)):
            counts = self._by_role.get(name, _NO_COUNTS)
            share = (counts.get(both, 0) + weight * share) / (counts.get(feature, 0) + weight)
        return math.log(share / anywhere)


class Evidence:
    """Scores mentions for roles, from built-in samples of English and from the pairs of a grammar.

    Args:
        derivations: symbols of commands and their forms, with the same wildcards on both sides.
    """

    def __init__(self, derivations: Iterable[tuple[Symbols, Form]] = ()) -> None:
        self._counts = RoleCounts()
        self._orders: defaultdict[tuple[str, str, int], Counter[tuple[int, ...]]]
        self._orders = defaultdict(Counter)
        self._with_or: set[tuple[str, str]] = set()
        self._wildcards: defaultdict[str, set[Wildcard]] = defaultdict(set)
        for text, form in sample_commands():
            self._learn(words_of(text), read_form(form))
        for symbols, intact in derivations:
            self._learn_derivation(symbols, intact)

    def score(self, context: Context, role: SlotRole) -> float:
        """Return the log odds that a mention in this context fills a slot of this role."""
        cue = self._counts.log_odds("cue", context.cue, role)
        return cue + self._counts.log_odds("near", context.neighbour, role)

    def fit(self, entities: Sequence[Entity], role: SlotRole) -> float:
        """Return a penalty if the grammar never has an entity of such a kind in this role."""
        allowed = self._wildcards.get(role.exact)
        if not allowed or any(is_of_type(each, kind) for each in entities for kind in allowed):
            return 0.0
        return _MISFIT

    def orders(self, form: str, entity_class: str, named: int) -> Mapping[tuple[int, ...], int]:
        """Return how often which order of mentions goes with the slots of a class in this form.

        ``(1, 0, 0)``: the second value of the command fills the first slot, the first one the others.
        Counted over the commands that name as many values of the class. ``form`` is canonical text.
        """
        return self._orders.get((form, entity_class, named), _NO_ORDERS)

    def has_with_or(self, form: str, entity_class: str) -> bool:
        """Return whether a command of this form says "or" beside several values of a class."""
        return (form, entity_class) in self._with_or

    def _learn_derivation(self, symbols: Symbols, form: Form) -> None:
        for path, wildcard in wildcards_of(form):
            if not wildcard.obfuscated:
                self._wildcards[role_of(form, path).exact].add(wildcard)
        self._learn(*as_pair(symbols, form))

    def _learn(self, words: Sequence[str], form: Form) -> None:
        """Count the contexts of the first mentions by role, and the order of the mentions."""
        slots = [(path, token) for path, token in tokens_of(form) if token in words]
        by_class: defaultdict[str, list[str]] = defaultdict(list)
        for path, token in slots:
            by_class[class_of(token)].append(token)
            context = context_of(words, words.index(token))
            self._counts.add({"cue": context.cue, "near": context.neighbour}, role_of(form, path))
        plain = canonical_text(_plain(form)) if by_class else ""
        for entity_class, tokens in by_class.items():
            mentioned = [word for word in dict.fromkeys(words) if class_of(word) == entity_class]
            order = tuple(map(mentioned.index, tokens))
            self._orders[plain, entity_class, len(mentioned)][order] += 1
            if len(mentioned) > 1 and CHOOSING_WORDS.intersection(words):
                self._with_or.add((plain, entity_class))


def as_pair(symbols: Symbols, form: Form) -> tuple[list[str], Form]:
    """Return the words and the form of a derivation, with tokens that the identities of its wildcards number."""
    numbers: dict[tuple[str, int | None], int] = {}
    words: list[str] = []
    for symbol in symbols:
        if isinstance(symbol, Wildcard) and symbol.entity_class:
            number = numbers.setdefault(symbol.identity, len(numbers))
            words.append(f"<{symbol.entity_class}{number}>")
        elif isinstance(symbol, Wildcard | Text):
            words += words_of(symbol.token if isinstance(symbol, Wildcard) else symbol.value)
    return words, _number(form, numbers)


@cache
def default_evidence() -> Evidence:
    """Return what English alone tells, without the grammar of a world."""
    return Evidence()


def wildcards_of(form: Form, path: SlotPath = ()) -> Iterator[tuple[SlotPath, Wildcard]]:
    """Yield the wildcards of a form with the ways to them, in order."""
    if isinstance(form, Wildcard):
        yield path, form
    for place, child in enumerate(children(form)):
        yield from wildcards_of(child, (*path, place))


def _number(form: Form, numbers: Mapping[tuple[str, int | None], int]) -> Form:
    """Replace wildcards with tokens that have their numbers."""
    if isinstance(form, Wildcard):
        return Constant(f"<{form.entity_class}{numbers.get(form.identity, len(numbers))}>")
    return _with_children(form, tuple(_number(each, numbers) for each in children(form)))


def _plain(form: Form) -> Form:
    """Remove the numbers of class tokens."""
    if isinstance(form, Constant) and form.token_class:
        return Constant(f"<{form.token_class}>")
    return _with_children(form, tuple(map(_plain, children(form))))


def _with_children(form: Form, parts: tuple[Form, ...]) -> Form:
    if isinstance(form, Lambda):
        return replace(form, bodies=parts)
    return replace(form, arguments=parts) if isinstance(form, Application) else form
