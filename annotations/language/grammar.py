"""A command grammar: productions of one or more files taken together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from annotations.language.ambiguity import repetitions
from annotations.language.derivations import Expander, anonymized, readable
from annotations.language.errors import LanguageError, Problem
from annotations.language.grammar_graph import Traversal, reachable, traverse
from annotations.language.grammar_problems import (
    cycle_text,
    find_problems,
    find_too_high,
    place_of,
)
from annotations.language.productions import (
    GrammarFile,
    Production,
    print_production,
    print_productions,
    read_production,
    read_productions,
)
from annotations.language.symbols import Choice, Nonterminal, Sequence, Text, Wildcard, walk

__all__ = [
    "ROOT",
    "Grammar",
    "GrammarFile",
    "Production",
    "print_production",
    "print_productions",
    "read_production",
    "read_productions",
]

ROOT = "Main"


@dataclass(frozen=True)
class Grammar:
    """Productions in order. Everything else about the grammar is computed from them, once."""

    productions: tuple[Production, ...]

    @cached_property
    def rules(self) -> dict[str, tuple[Sequence, ...]]:
        """Nonterminal → its distinct alternatives in the order of the files."""
        found: dict[str, dict[Sequence, None]] = {}
        for production in self.productions:
            alternatives = found.setdefault(production.nonterminal, {})
            alternatives.update(dict.fromkeys(_top_level(production.expansion)))
        return {name: tuple(alternatives) for name, alternatives in found.items()}

    @cached_property
    def edges(self) -> dict[str, tuple[str, ...]]:
        """Nonterminal → the nonterminals it mentions, those in notes for the referee included."""
        return {
            name: tuple(
                dict.fromkeys(
                    symbol.name
                    for alternative in alternatives
                    for symbol in walk(alternative, notes=True)
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
        """Expands anything over this grammar into anonymized words.

        Raises:
            LanguageError: the grammar has a cycle, or nests deeper than ``grammar_graph.MAX_HEIGHT``.
        """
        self.require_finite()
        return Expander(self.alternatives, anonymized)

    def alternatives(self, name: str) -> tuple[Sequence, ...]:
        """The alternatives of ``$name``; none where it is undefined."""
        return self.rules.get(name, ())

    def reachable(self, name: str = ROOT) -> frozenset[str]:
        """``name`` and every nonterminal it can reach."""
        return reachable(self.edges, name)

    def problems(self, root: str = ROOT) -> tuple[Problem, ...]:
        """A missing root, a cycle and too deep nesting (errors); undefined and unreachable
        nonterminals and lines that repeat one another (warnings)."""
        found = find_problems(self.productions, self.rules, self.edges, self.traversal, root)
        if any(problem.is_error for problem in found):
            return found
        return (*found, *repetitions(self.productions, self.alternatives))

    def require_finite(self) -> None:
        """Raises LanguageError where expanding would not end, or would nest too deep."""
        if self.traversal.cycles:
            raise LanguageError(
                f"the grammar has a cycle: {cycle_text(self.traversal.cycles[0])}",
                place_of(self.productions, self.traversal.cycles[0][0]),
            )
        too_high = find_too_high(self.productions, self.rules, self.traversal)
        if too_high is not None:
            raise LanguageError(too_high.message, too_high.position, too_high.hint)

    def size(self, root: str = ROOT) -> int:
        """At least the number of distinct anonymized commands, without enumerating them.

        It counts derivations after equal anonymized alternatives have collapsed: exact where no
        two derivations give one command.
        """
        return self.expander.size((Nonterminal(root),))

    def commands(self, root: str = ROOT, limit: int | None = None) -> Iterator[str]:
        """Streams the distinct anonymized commands in grammar order.

        Args:
            limit: refuse a grammar whose size is above this; None streams whatever comes.

        Raises:
            LanguageError: at the call, naming the size, where it is above the limit.
        """
        size = self.size(root)
        if limit is not None and size > limit:
            raise LanguageError(
                f"${root} has up to {readable(size)} commands, more than the limit of {limit:,}",
                place_of(self.productions, root),
                "raise the limit, or expand a nonterminal further down",
            )
        return self._distinct(root)

    def spoken(
        self, sequence: Sequence, opaque: frozenset[str] = frozenset()
    ) -> tuple[Nonterminal | Wildcard, ...]:
        """The distinct nonterminals and wildcards that can take part in the words of a sequence.

        What only notes mention is left out, and so is what lies below an ``opaque`` nonterminal.
        """
        found: dict[Nonterminal | Wildcard, None] = {}
        waiting = [sequence]
        while waiting:
            for symbol in walk(waiting.pop(), notes=False):
                if isinstance(symbol, Text) or symbol in found:
                    continue
                found[symbol] = None
                if isinstance(symbol, Nonterminal) and symbol.name not in opaque:
                    waiting.extend(self.alternatives(symbol.name))
        return tuple(found)

    def _distinct(self, root: str) -> Iterator[str]:
        seen: set[str] = set()
        for words, _ in self.expander.stream((Nonterminal(root),)):
            command = " ".join(words)
            if command and command not in seen:
                seen.add(command)
                yield command


def _top_level(expansion: Sequence) -> tuple[Sequence, ...]:
    if len(expansion) == 1 and isinstance(expansion[0], Choice):
        return expansion[0].alternatives
    return (expansion,)
