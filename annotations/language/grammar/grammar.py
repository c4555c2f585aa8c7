"""A command grammar: productions of one or more files taken together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from annotations.language.forms import Choice, Nonterminal, Symbols, Text, Wildcard, walk_symbols
from annotations.language.grammar.budget import Budget
from annotations.language.grammar.expander import Expander, anonymized, readable
from annotations.language.grammar.grammar_problems import (
    cycle_text,
    find_problems,
    find_too_large,
    place_of,
    repetitions,
)
from annotations.language.grammar.graph import Traversal, length, lengths, reachable, traverse
from annotations.language.grammar.productions import Production
from annotations.language.texts import LanguageError, Problem

ROOT = "Main"


@dataclass(frozen=True)
class Grammar:
    """Productions in order. Everything else about the grammar is computed from them, once."""

    productions: tuple[Production, ...]

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        return hash(self.productions)

    @cached_property
    def rules(self) -> dict[str, tuple[Symbols, ...]]:
        """Nonterminal → its distinct alternatives in the order of the files."""
        by_name: dict[str, dict[Symbols, None]] = {}
        for production in self.productions:
            alternatives = by_name.setdefault(production.nonterminal, {})
            expansion = production.expansion
            only = expansion[0] if len(expansion) == 1 else None
            top_level = only.alternatives if isinstance(only, Choice) else (expansion,)
            alternatives.update(dict.fromkeys(top_level))
        return {name: tuple(alternatives) for name, alternatives in by_name.items()}

    @cached_property
    def edges(self) -> dict[str, tuple[str, ...]]:
        """Nonterminal → the nonterminals it mentions, including those in notes for the referee."""
        return {
            name: tuple(
                dict.fromkeys(
                    symbol.name
                    for alternative in alternatives
                    for symbol in walk_symbols(alternative, notes=True)
                    if isinstance(symbol, Nonterminal)
                )
            )
            for name, alternatives in self.rules.items()
        }

    @cached_property
    def traversal(self) -> Traversal:
        return traverse(self.edges)

    @cached_property
    def expander(self) -> Expander[str]:
        """The expander of this grammar into anonymized words.

        Raises:
            LanguageError: the grammar has a cycle, nests deeper than ``graph.MAX_HEIGHT`` or has
                commands of more than ``graph.MAX_WORDS`` words.
        """
        self.require_finite()
        return Expander(self.alternatives, anonymized)

    def alternatives(self, name: str) -> tuple[Symbols, ...]:
        """Return the alternatives of ``$name``; none if it is undefined."""
        return self.rules.get(name, ())

    def reachable(self, name: str = ROOT) -> frozenset[str]:
        """Return ``name`` and every nonterminal it can reach."""
        return reachable(self.edges, name)

    def problems(self) -> tuple[Problem, ...]:
        """Return the problems of the grammar, looked for once.

        Errors are a missing root, a cycle, too deep nesting and too long commands; warnings are
        undefined and unreachable nonterminals and lines that repeat one another.
        """
        return self._problems

    def require_finite(self) -> None:
        """Raise LanguageError if expanding would not end, nest too deep or make texts that are too long."""
        if self.traversal.cycles:
            raise LanguageError(
                f"the grammar has a cycle: {cycle_text(self.traversal.cycles[0])}",
                place_of(self.productions, self.traversal.cycles[0][0]),
            )
        if self._too_large is not None:
            problem = self._too_large
            raise LanguageError(problem.message, problem.position, problem.hint)

    def longest(self, sequence: Symbols) -> int:
        """Return the largest number of words that a sequence can become, without expanding it."""
        self.require_finite()
        return length(sequence, self._lengths)

    @cached_property
    def _problems(self) -> tuple[Problem, ...]:
        problems = find_problems(self.productions, self.rules, self.edges, self.traversal, ROOT)
        if any(problem.is_error for problem in problems):
            return problems
        return (*problems, *repetitions(self.productions, self.alternatives))

    @cached_property
    def _too_large(self) -> Problem | None:
        return find_too_large(self.productions, self.rules, self.traversal)

    @cached_property
    def _lengths(self) -> dict[str, int]:
        return lengths(self.rules, self.traversal.order)

    def size(self, root: str = ROOT) -> int:
        """Return an upper bound on the number of distinct anonymized commands, without enumeration.

        It counts derivations after equal anonymized alternatives are merged, so it is exact if no
        two derivations give the same command.
        """
        return self.expander.size((Nonterminal(root),))

    def commands(
        self, root: str = ROOT, limit: int | None = None, budget: Budget | None = None
    ) -> Iterator[str]:
        """Stream the distinct anonymized commands in grammar order.

        Args:
            limit: refuse a grammar whose size is above this; None for no limit.

        Raises:
            LanguageError: at the call, if the size is above the limit.
            TooManyCombinations: while streaming, when the budget is spent.
        """
        size = self.size(root)
        if limit is not None and size > limit:
            raise LanguageError(
                f"${root} has up to {readable(size)} commands, more than the limit of {limit:,}",
                place_of(self.productions, root),
                "raise the limit, or expand a nonterminal further down",
            )
        return self._distinct(root, budget)

    def spoken(
        self, sequence: Symbols, opaque: frozenset[str] = frozenset()
    ) -> tuple[Nonterminal | Wildcard, ...]:
        """Return the distinct nonterminals and wildcards that can contribute words to a sequence.

        Leaves out what only notes mention and what is below an ``opaque`` nonterminal.
        """
        spoken: dict[Nonterminal | Wildcard, None] = {}
        waiting = [sequence]
        while waiting:
            for symbol in walk_symbols(waiting.pop(), notes=False):
                if isinstance(symbol, Text) or symbol in spoken:
                    continue
                spoken[symbol] = None
                if isinstance(symbol, Nonterminal) and symbol.name not in opaque:
                    waiting.extend(self.alternatives(symbol.name))
        return tuple(spoken)

    def _distinct(self, root: str, budget: Budget | None) -> Iterator[str]:
        seen: set[str] = set()
        for words, _ in self.expander.stream((Nonterminal(root),), budget):
            command = " ".join(words)
            if command and command not in seen:
                seen.add(command)
                yield command
