"""Expand a sequence of symbols: count the results without enumeration, or stream them on demand.

One engine serves commands of a grammar, anonymized pairs and pairs with their wildcards intact:
they differ only in what a leaf becomes. Nonterminals that a form mentions are *tracked*: each
result says what they became, and every occurrence of one becomes the same (synchronous expansion).

Every combination that is tried, even one that is discarded, spends steps of the caller's
``Budget``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import chain, product
from math import log10, prod
from typing import Any, Generic, TypeAlias, TypeVar

from annotations.language.forms import Choice, Nonterminal, Symbols, Text, Wildcard
from annotations.language.grammar.budget import Budget

Item = TypeVar("Item")
# Tracked nonterminal → the items it became, or what ``Compose`` gives for it; sorted by name.
Bindings: TypeAlias = "tuple[tuple[str, Any], ...]"
Derived: TypeAlias = "tuple[tuple[Item, ...], Bindings]"
# Yields what a tracked nonterminal becomes, and the value to report in place of its items.
Compose: TypeAlias = "Callable[[str, Budget], Iterator[tuple[tuple[Item, ...], Any]]]"
# A run of leaves already turned into items, or a symbol with alternatives.
Part: TypeAlias = "tuple[Item, ...] | Nonterminal | Choice"

# A nonterminal with at most this many expansions is expanded once and kept.
KEPT_EXPANSIONS = 10_000


class Expander(Generic[Item]):
    """Expands sequences over one acyclic grammar.

    Args:
        alternatives: nonterminal → its alternatives; none for an undefined one.
        leaf: what a word or a wildcard becomes: zero, one or more items.
        tracked: nonterminals whose expansion each result reports as a binding.
        composed: those of them that ``compose`` expands in place of their alternatives.
        mark: changes the items of the other tracked ones.
    """

    def __init__(
        self,
        alternatives: Callable[[str], tuple[Symbols, ...]],
        leaf: Callable[[Text | Wildcard], tuple[Item, ...]],
        tracked: frozenset[str] = frozenset(),
        composed: frozenset[str] = frozenset(),
        compose: Compose[Item] | None = None,
        mark: Callable[[str, tuple[Item, ...]], tuple[Item, ...]] | None = None,
    ) -> None:
        self._alternatives = alternatives
        self._leaf = leaf
        self._tracked = tracked
        self._composed = composed
        self._compose = compose
        self._mark = mark
        self._rules: dict[Nonterminal | Choice, tuple[tuple[Part[Item], ...], ...]] = {}
        self._sizes: dict[Nonterminal | Choice, int] = {}
        self._kept: dict[Nonterminal | Choice, tuple[Derived[Item], ...]] = {}

    def size(self, sequence: Symbols) -> int:
        """Return the number of derivations, an upper bound on the number of distinct results.

        This is exact integer arithmetic without enumeration, so even 10¹² is computed at once.
        """
        return self._size_of_parts(self.parts(sequence))

    def stream(self, sequence: Symbols, budget: Budget | None = None) -> Iterator[Derived[Item]]:
        """Yield (items, bindings) in grammar order, lazily; a result may occur more than once.

        Raises:
            TooManyCombinations: while streaming, when the budget is spent.
        """
        return self._combine(self.parts(sequence), budget or Budget())

    def parts(self, sequence: Symbols) -> tuple[Part[Item], ...]:
        """Return the sequence with neighbouring leaves joined into runs."""
        parts: list[Part[Item]] = []
        run: list[Item] = []
        for symbol in sequence:
            if isinstance(symbol, Text | Wildcard):
                run.extend(self._leaf(symbol))
                continue
            if run:
                parts.append(tuple(run))
                run = []
            parts.append(symbol)
        return (*parts, tuple(run)) if run else tuple(parts)

    def rules(self, symbol: Nonterminal | Choice) -> tuple[tuple[Part[Item], ...], ...]:
        """Return the distinct alternatives of a symbol; those whose leaves become the same are merged."""
        if symbol not in self._rules:
            alternatives = (
                symbol.alternatives
                if isinstance(symbol, Choice)
                else self._alternatives(symbol.name)
            )
            rules = tuple(self.parts(each) for each in alternatives)
            # Lines with one pattern have forms of their own.
            is_composed = isinstance(symbol, Nonterminal) and symbol.name in self._composed
            self._rules[symbol] = rules if is_composed else tuple(dict.fromkeys(rules))
        return self._rules[symbol]

    def _size_of_parts(self, parts: tuple[Part[Item], ...]) -> int:
        return prod(1 if isinstance(part, tuple) else self._size_of(part) for part in parts)

    def _size_of(self, symbol: Nonterminal | Choice) -> int:
        if symbol not in self._sizes:
            self._sizes[symbol] = sum(self._size_of_parts(parts) for parts in self.rules(symbol))
        return self._sizes[symbol]

    def _combine(self, parts: tuple[Part[Item], ...], budget: Budget) -> Iterator[Derived[Item]]:
        """Yield every combination of what the parts become; the last part varies fastest."""
        budget.spend(len(parts) + 1)
        if len(parts) == 1:
            yield from self._expand_part(parts[0], budget)
            return
        size = self._size_of_parts(parts)
        if size == 0:
            return
        # Many combinations may disagree about a tracked nonterminal: joining halves drops those early.
        is_small = size <= KEPT_EXPANSIONS or not self._tracked
        if is_small and all(self._is_kept(part) for part in parts):
            for combination in product(*(self._expand_part(part, budget) for part in parts)):
                joined = _join(combination, budget)
                if joined is not None:
                    yield joined
            return
        middle = len(parts) // 2
        for left in self._combine(parts[:middle], budget):
            for right in self._combine(parts[middle:], budget):
                joined = _join((left, right), budget)
                if joined is not None:
                    yield joined

    def _is_kept(self, part: Part[Item]) -> bool:
        return isinstance(part, tuple) or self._size_of(part) <= KEPT_EXPANSIONS

    def _expand_part(self, part: Part[Item], budget: Budget) -> Iterable[Derived[Item]]:
        if isinstance(part, tuple):
            return ((part, ()),)
        if not self._is_kept(part):
            return self._derive(part, budget)
        if part not in self._kept:
            self._kept[part] = tuple(dict.fromkeys(self._derive(part, budget)))
        return self._kept[part]

    def _derive(self, symbol: Nonterminal | Choice, budget: Budget) -> Iterator[Derived[Item]]:
        is_tracked = isinstance(symbol, Nonterminal) and symbol.name in self._tracked
        if self._compose and isinstance(symbol, Nonterminal) and symbol.name in self._composed:
            for items, value in self._compose(symbol.name, budget):
                budget.spend()
                yield items, ((symbol.name, value),)
            return
        for parts in self.rules(symbol):
            for items, bindings in self._combine(parts, budget):
                budget.spend()
                if is_tracked and isinstance(symbol, Nonterminal):
                    if self._mark:
                        items = self._mark(symbol.name, items)
                    bindings = tuple(sorted((*bindings, (symbol.name, items)), key=_name))
                yield items, bindings


def anonymized(symbol: Text | Wildcard) -> tuple[str, ...]:
    """Return the words that a leaf contributes to an anonymized command."""
    word = symbol.value if isinstance(symbol, Text) else symbol.token
    return (word,) if word else ()


def intact(symbol: Text | Wildcard) -> tuple[Text | Wildcard, ...]:
    """Return the leaf itself; void wildcards stay too, because they carry notes."""
    return (symbol,)


def readable(size: int) -> str:
    """Return a size for a sentence: exact up to 10¹⁵, a power of ten above that.

    Sizes may have thousands of digits, which Python refuses to print.
    """
    if size <= 10**15:
        return f"{size:,}"
    return f"about 10^{int(size.bit_length() * log10(2))}"


def _join(pieces: tuple[Derived[Item], ...], budget: Budget) -> Derived[Item] | None:
    """Join several results side by side, or return None if they disagree about a nonterminal."""
    items: tuple[Item, ...] = ()
    binding: list[Bindings] = []
    for words, bindings in pieces:
        items += words
        if bindings:
            binding.append(bindings)
    budget.spend(len(pieces) + len(items))
    if len(binding) < 2:
        return items, binding[0] if binding else ()
    bound: dict[str, Any] = {}
    for name, value in chain.from_iterable(binding):
        if bound.setdefault(name, value) != value:
            return None
    return items, tuple(sorted(bound.items(), key=_name))


def _name(binding: tuple[str, Any]) -> str:
    return binding[0]
