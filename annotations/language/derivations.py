"""Everything a sequence of symbols can become: counted without enumeration, streamed on demand.

One engine serves commands of a grammar, anonymized pairs and pairs with their wildcards intact:
they differ in what a leaf becomes. Nonterminals that a form mentions are *tracked*: each result says
what they became, and every occurrence of one becomes the same (synchronous expansion).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import chain, product
from math import log10, prod
from typing import Generic, TypeAlias, TypeVar

from annotations.language.symbols import Choice, Nonterminal, Sequence, Text, Wildcard

Item = TypeVar("Item")
# Tracked nonterminal → the items it became, sorted by name.
Bindings: TypeAlias = "tuple[tuple[str, tuple[Item, ...]], ...]"
Derived: TypeAlias = "tuple[tuple[Item, ...], Bindings[Item]]"
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
    """

    def __init__(
        self,
        alternatives: Callable[[str], tuple[Sequence, ...]],
        leaf: Callable[[Text | Wildcard], tuple[Item, ...]],
        tracked: frozenset[str] = frozenset(),
    ) -> None:
        self._alternatives = alternatives
        self._leaf = leaf
        self._tracked = tracked
        self._rules: dict[Nonterminal | Choice, tuple[tuple[Part[Item], ...], ...]] = {}
        self._sizes: dict[Nonterminal | Choice, int] = {}
        self._kept: dict[Nonterminal | Choice, tuple[Derived[Item], ...]] = {}

    def size(self, sequence: Sequence) -> int:
        """The number of derivations: an upper bound of the number of distinct results.

        Exact integer arithmetic without enumeration, so 10¹² answers at once.
        """
        return self._size_of_parts(self.parts(sequence))

    def stream(self, sequence: Sequence) -> Iterator[Derived[Item]]:
        """Yields (items, bindings) in grammar order, lazily; repetitions may occur."""
        return self._combine(self.parts(sequence))

    def parts(self, sequence: Sequence) -> tuple[Part[Item], ...]:
        """The sequence with neighbouring leaves joined to one run."""
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
        """The alternatives of a symbol, collapsed where their leaves become the same."""
        if symbol not in self._rules:
            found = (
                symbol.alternatives
                if isinstance(symbol, Choice)
                else self._alternatives(symbol.name)
            )
            self._rules[symbol] = tuple(dict.fromkeys(self.parts(each) for each in found))
        return self._rules[symbol]

    def _size_of_parts(self, parts: tuple[Part[Item], ...]) -> int:
        return prod(1 if isinstance(part, tuple) else self._size_of(part) for part in parts)

    def _size_of(self, symbol: Nonterminal | Choice) -> int:
        if symbol not in self._sizes:
            self._sizes[symbol] = sum(self._size_of_parts(parts) for parts in self.rules(symbol))
        return self._sizes[symbol]

    def _combine(self, parts: tuple[Part[Item], ...]) -> Iterator[Derived[Item]]:
        """Every combination of what the parts become, the last one varying fastest."""
        if len(parts) == 1:
            yield from self._derived(parts[0])
            return
        size = self._size_of_parts(parts)
        if size == 0:
            return
        # Many combinations may disagree about a tracked nonterminal: halves drop those early.
        is_small = size <= KEPT_EXPANSIONS or not self._tracked
        if is_small and all(self._is_kept(part) for part in parts):
            for combination in product(*(self._derived(part) for part in parts)):
                joined = _joined(combination)
                if joined is not None:
                    yield joined
            return
        middle = len(parts) // 2
        for left in self._combine(parts[:middle]):
            for right in self._combine(parts[middle:]):
                joined = _joined((left, right))
                if joined is not None:
                    yield joined

    def _is_kept(self, part: Part[Item]) -> bool:
        return isinstance(part, tuple) or self._size_of(part) <= KEPT_EXPANSIONS

    def _derived(self, part: Part[Item]) -> Iterable[Derived[Item]]:
        if isinstance(part, tuple):
            return ((part, ()),)
        if not self._is_kept(part):
            return self._derive(part)
        if part not in self._kept:
            self._kept[part] = tuple(dict.fromkeys(self._derive(part)))
        return self._kept[part]

    def _derive(self, symbol: Nonterminal | Choice) -> Iterator[Derived[Item]]:
        is_tracked = isinstance(symbol, Nonterminal) and symbol.name in self._tracked
        for parts in self.rules(symbol):
            for items, bindings in self._combine(parts):
                if is_tracked and isinstance(symbol, Nonterminal):
                    bindings = tuple(sorted((*bindings, (symbol.name, items)), key=_name))
                yield items, bindings


def anonymized(symbol: Text | Wildcard) -> tuple[str, ...]:
    """The words that a leaf contributes to an anonymized command."""
    word = symbol.value if isinstance(symbol, Text) else symbol.token
    return (word,) if word else ()


def intact(symbol: Text | Wildcard) -> tuple[Text | Wildcard, ...]:
    """The leaf itself: void wildcards stay too, for the note they carry."""
    return (symbol,)


def readable(size: int) -> str:
    """A size for a sentence: exact up to 10¹⁵, a power of ten above (sizes may have thousands of
    digits, which Python refuses to print)."""
    if size <= 10**15:
        return f"{size:,}"
    return f"about 10^{int(size.bit_length() * log10(2))}"


def _joined(pieces: tuple[Derived[Item], ...]) -> Derived[Item] | None:
    """One result out of several side by side, or None where they disagree about a nonterminal."""
    items = tuple(chain.from_iterable(piece[0] for piece in pieces))
    bound: dict[str, tuple[Item, ...]] = {}
    for name, value in chain.from_iterable(piece[1] for piece in pieces):
        if bound.setdefault(name, value) != value:
            return None
    return items, tuple(sorted(bound.items(), key=_name))


def _name(binding: tuple[str, tuple[Item, ...]]) -> str:
    return binding[0]
