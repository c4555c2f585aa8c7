"""Make a pattern from a command without a form: as general as its siblings in the grammar allow."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass
from difflib import SequenceMatcher
from functools import cached_property
from heapq import nlargest
from itertools import islice
from typing import TypeAlias

from annotations.language.forms import Choice, Nonterminal, Symbol, Symbols, Text, Wildcard
from annotations.language.grammar import (
    CHECK_STEPS,
    ROOT,
    Budget,
    Chart,
    Grammar,
    Lattice,
    RuleBook,
    TooManyCombinations,
    anonymized,
)
from annotations.language.templates.filling import bare
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.templates.units import UnitReader
from annotations.language.texts import LanguageError

# An ambiguous command is looked at in this many ways, and a pattern with more commands is too general.
MOST_DERIVATIONS, MOST_COMMANDS = 20, 5_000
# Commands that share the most words are compared in order, and the nearest of them become patterns.
MOST_COMPARED, MOST_GENERALISED = 60, 12


@dataclass(frozen=True, slots=True)
class DerivationNode:
    """A nonterminal or a choice with what one of its alternatives became; ``words`` are those it says."""

    symbol: Nonterminal | Choice
    parts: tuple[DerivationPart, ...]
    words: tuple[str, ...]


DerivationPart: TypeAlias = "DerivationNode | Text | Wildcard"


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
        self._chart = Chart(self._book, Lattice.of_words(self.words), budget)
        self._budget = budget

    def derivations(self, root: str = ROOT) -> Iterator[DerivationNode]:
        """Yield the derivation trees of the command; there are none for one outside the grammar."""
        symbol = Nonterminal(root)
        if self.words and len(self.words) in self._ends(symbol, 0):
            yield from self._nodes(symbol, 0, len(self.words))

    def _nodes(
        self, symbol: Nonterminal | Choice, start: int, end: int
    ) -> Iterator[DerivationNode]:
        alternatives = (
            symbol.alternatives
            if isinstance(symbol, Choice)
            else self.grammar.alternatives(symbol.name)
        )
        for alternative in alternatives:
            for parts in self._sequences(alternative, start, end):
                yield DerivationNode(symbol, parts, self.words[start:end])

    def _sequences(
        self, symbols: Symbols, start: int, end: int
    ) -> Iterator[tuple[DerivationPart, ...]]:
        """Yield what a sequence can be when it spans the words from ``start`` to ``end``."""
        self._budget.spend()
        if not symbols:
            if start == end:
                yield ()
            return
        first, rest = symbols[0], symbols[1:]
        for stop in sorted(self._ends(first, start)):
            places = {stop}
            for symbol in rest:
                places = {further for place in places for further in self._ends(symbol, place)}
            if end not in places:
                continue
            parts = (
                (first,) if isinstance(first, Text | Wildcard) else self._nodes(first, start, stop)
            )
            for part in parts:
                for others in self._sequences(rest, stop, end):
                    yield (part, *others)

    def _ends(self, symbol: Symbol, start: int) -> frozenset[int]:
        if isinstance(symbol, Text | Wildcard):
            words = anonymized(symbol)
            stop = start + len(words)
            return frozenset((stop,)) if self.words[start:stop] == words else frozenset()
        return self._chart.ends(self._book.number(symbol), start)


@dataclass(frozen=True)
class PatternMaker:
    """Makes patterns of one grammar.

    A nonterminal replaces its words if no command that this adds has a form already, and if its phrases
    seem to share one. They seem to if templates write the nonterminal too, or if it is a class of words,
    such as verbs, that no template writes out. Otherwise a choice that a template writes may replace them.
    """

    grammar: Grammar
    templates: tuple[SemanticTemplate, ...]
    commands_with_form: Container[str]

    def pattern(self, command: str) -> Symbols | None:
        """Return a pattern that makes an anonymized command and otherwise only commands without a form.

        None if the grammar does not derive the command, or only in too many steps.
        """
        budget = Budget(CHECK_STEPS)
        try:
            derivations = Deriver(self.grammar, command, budget).derivations()
            patterns = [self._generalise(each) for each in islice(derivations, MOST_DERIVATIONS)]
        except TooManyCombinations:
            return None
        return max(patterns, key=self._size, default=None)

    def _generalise(self, root: DerivationNode) -> Symbols:
        written: dict[int, Symbol] = {}
        for node in _nodes_inside(root):
            symbol = self._symbol_for(node)
            wider = {**written, id(node): symbol} if symbol else written
            if symbol and not self._has_forms(_write(root, wider)):
                written = wider
        return _write(root, written)

    def _size(self, pattern: Symbols) -> int:
        return self.grammar.expander.size(pattern)

    def _symbol_for(self, node: DerivationNode) -> Nonterminal | Choice | None:
        """Return what may stand for a node's words, or None."""
        symbol, phrases = node.symbol, self._reader.phrases(node.symbol)
        if isinstance(symbol, Nonterminal) and symbol in self._written:
            return symbol
        if phrases is None:
            return None
        is_words = not any("<" in phrase for phrase in phrases)
        is_entity = all(phrase.startswith("<") and " " not in phrase for phrase in phrases)
        said = frozenset(word for phrase in phrases for word in phrase.split())
        has_several = len(self._reader.alternatives(symbol)) > 1
        if (is_words or is_entity) and has_several and not self._words_written & said:
            return symbol
        phrase = " ".join(node.words).lower()
        for choice in self._written:
            own = self._reader.phrases(choice) if isinstance(choice, Choice) else None
            if own is not None and phrase in own and own <= phrases:
                return choice
        return None

    def _has_forms(self, pattern: Symbols) -> bool:
        """Return whether a command of the pattern has a form already, or there are too many to tell."""
        if self._size(pattern) > MOST_COMMANDS:
            return True
        try:
            stream = self.grammar.expander.stream(pattern, Budget(CHECK_STEPS))
            return any(" ".join(words) in self.commands_with_form for words, _ in stream)
        except LanguageError:
            return True

    @cached_property
    def _reader(self) -> UnitReader:
        return UnitReader(self.grammar)

    @cached_property
    def _written(self) -> dict[Nonterminal | Choice, None]:
        """The nonterminals and choices that templates write."""
        symbols = (each for template in self.templates for each in _symbols(template.pattern))
        return {each: None for each in symbols if isinstance(each, Nonterminal | Choice)}

    @cached_property
    def _words_written(self) -> frozenset[str]:
        """The words that templates write out."""
        symbols = (each for template in self.templates for each in _symbols(template.pattern))
        return frozenset(each.value.lower() for each in symbols if isinstance(each, Text))


def _symbols(sequence: Symbols) -> Iterator[Symbol]:
    for symbol in sequence:
        yield symbol
        if isinstance(symbol, Choice):
            for alternative in symbol.alternatives:
                yield from _symbols(alternative)


def _nodes_inside(root: DerivationNode) -> Iterator[DerivationNode]:
    """Yield the nodes below the root, inner ones first."""
    for part in root.parts:
        if isinstance(part, DerivationNode):
            yield from _nodes_inside(part)
            yield part


def _write(node: DerivationNode, written: dict[int, Symbol]) -> Symbols:
    """Return the words and slots of a node, with a symbol in place of each node that has one in ``written``."""
    symbols: list[Symbol] = []
    for part in node.parts:
        if isinstance(part, DerivationNode):
            instead = written.get(id(part))
            symbols.extend((instead,) if instead else _write(part, written))
        elif isinstance(part, Text):
            symbols.append(part)
        elif part.token:
            symbols.append(bare(part))
    return tuple(symbols)


def nearest_patterns(
    command: str,
    commands: Iterable[str],
    grammar: Grammar,
    templates: tuple[SemanticTemplate, ...],
    most: int = 5,
) -> list[tuple[str, Symbols]]:
    """Return up to ``most`` distinct patterns of the grammar, the nearest first, each with a command of it.

    Args:
        command: what the template makes.
        commands: those that the grammar derives; each is looked at once.
        templates: they show which nonterminals patterns are written with.
    """
    words = command.split()
    said = frozenset(words)

    def shared(other: str) -> float:
        others = frozenset(other.split())
        return len(said & others) / len(said | others)

    def likeness(other: str) -> float:
        return SequenceMatcher(None, words, other.split(), False).ratio()

    candidates = nlargest(MOST_COMPARED, commands, key=shared)
    nearest = nlargest(MOST_GENERALISED, candidates, key=likeness)
    maker = PatternMaker(grammar, templates, frozenset())
    patterns: dict[Symbols, str] = {}
    for example in nearest:
        pattern = maker.pattern(example)
        if pattern is not None and len(patterns) < most:
            patterns.setdefault(pattern, example)
    return [(example, pattern) for pattern, example in patterns.items()]
