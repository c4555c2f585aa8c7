"""How a grammar derives a command: trees of productions, found with the chart of the recognizer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from annotations.language.grammar import ROOT, Budget, Chart, Grammar, RuleBook, anonymized
from annotations.language.symbols import Choice, Nonterminal, Symbol, Symbols, Text, Wildcard


@dataclass(frozen=True, slots=True)
class Node:
    """A nonterminal or a choice with what one of its alternatives became; ``words`` are those it says."""

    symbol: Nonterminal | Choice
    parts: tuple[Part, ...]
    words: tuple[str, ...]


Part: TypeAlias = "Node | Text | Wildcard"


class Deriver:
    """Finds the derivations of one command.

    Raises:
        LanguageError: the grammar has a cycle.
        TooManyCombinations: while looking, when the budget is spent.
    """

    def __init__(self, grammar: Grammar, command: str, budget: Budget) -> None:
        self.grammar = grammar
        self.words = tuple(command.split())
        self._book = RuleBook(grammar.expander)
        self._chart = Chart(self._book, self.words, budget)
        self._budget = budget

    def derivations(self, root: str = ROOT) -> Iterator[Node]:
        """Yield the derivation trees of the command; there are none for one outside the grammar."""
        symbol = Nonterminal(root)
        if self.words and len(self.words) in self._ends(symbol, 0):
            yield from self._nodes(symbol, 0, len(self.words))

    def _nodes(self, symbol: Nonterminal | Choice, start: int, end: int) -> Iterator[Node]:
        alternatives = (
            symbol.alternatives
            if isinstance(symbol, Choice)
            else self.grammar.alternatives(symbol.name)
        )
        for alternative in alternatives:
            for parts in self._sequences(alternative, start, end):
                yield Node(symbol, parts, self.words[start:end])

    def _sequences(self, symbols: Symbols, start: int, end: int) -> Iterator[tuple[Part, ...]]:
        """Yield what a sequence can be when it spans the words from ``start`` to ``end``."""
        self._budget.spend()
        if not symbols:
            if start == end:
                yield ()
            return
        first, rest = symbols[0], symbols[1:]
        for stop in sorted(self._ends(first, start)):
            if not self._reaches(rest, stop, end):
                continue
            parts = (
                (first,) if isinstance(first, Text | Wildcard) else self._nodes(first, start, stop)
            )
            for part in parts:
                for others in self._sequences(rest, stop, end):
                    yield (part, *others)

    def _reaches(self, symbols: Symbols, start: int, end: int) -> bool:
        places = {start}
        for symbol in symbols:
            places = {stop for place in places for stop in self._ends(symbol, place)}
        return end in places

    def _ends(self, symbol: Symbol, start: int) -> frozenset[int]:
        if isinstance(symbol, Text | Wildcard):
            words = anonymized(symbol)
            stop = start + len(words)
            return frozenset((stop,)) if self.words[start:stop] == words else frozenset()
        return self._chart.ends(self._book.number(symbol), start)
