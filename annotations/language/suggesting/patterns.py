"""Make a pattern from a command without a form: as general as its siblings in the grammar allow."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import islice

from annotations.language.errors import LanguageError
from annotations.language.grammar import CHECK_STEPS, Budget, Grammar, TooManyCombinations
from annotations.language.suggesting.derivations import Deriver, Node
from annotations.language.suggesting.units import UnitReader
from annotations.language.symbols import Choice, Nonterminal, Symbol, Symbols, Text
from annotations.language.templates import SemanticTemplate, bare

# An ambiguous command is looked at in this many ways, and a pattern with more commands is too general.
MOST_DERIVATIONS, MOST_COMMANDS = 20, 5_000


@dataclass(frozen=True)
class PatternMaker:
    """Makes patterns of one grammar.

    A nonterminal is written in place of its words if none of the commands that this adds has a form, and if
    its phrases seem to share one: templates write it too, or it is a class of verbs and the like, with
    words that no template writes out; else those of a choice that a template writes.
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

    def _generalise(self, root: Node) -> Symbols:
        written: dict[int, Symbol] = {}
        for node in _nodes_inside(root):
            symbol = self._symbol_for(node)
            wider = {**written, id(node): symbol} if symbol else written
            if symbol and not self._has_forms(_write(root, wider)):
                written = wider
        return _write(root, written)

    def _size(self, pattern: Symbols) -> int:
        return self.grammar.expander.size(pattern)

    def _symbol_for(self, node: Node) -> Nonterminal | Choice | None:
        """Return what may stand for a node's words, or None."""
        symbol, phrases = node.symbol, self._reader.phrases(node.symbol)
        if isinstance(symbol, Nonterminal) and symbol in self._written:
            return symbol
        if phrases is None:
            return None
        is_class = not any("<" in phrase for phrase in phrases) or _is_entity(phrases)
        has_several = len(self._reader.alternatives(symbol)) > 1
        if is_class and has_several and not self._words_written & _words(phrases):
            return symbol
        phrase = " ".join(node.words).lower()
        choices = (each for each in self._written if isinstance(each, Choice))
        return next((each for each in choices if self._chooses(each, phrase, phrases)), None)

    def _chooses(self, choice: Choice, phrase: str, phrases: frozenset[str]) -> bool:
        own = self._reader.phrases(choice)
        return own is not None and phrase in own and own <= phrases

    def _has_forms(self, pattern: Symbols) -> bool:
        """Return whether a command of the pattern has a form already, or whether they are too many to say."""
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


def _nodes_inside(root: Node) -> Iterator[Node]:
    """Yield the nodes below the root, inner ones first."""
    for part in root.parts:
        if isinstance(part, Node):
            yield from _nodes_inside(part)
            yield part


def _write(node: Node, written: dict[int, Symbol]) -> Symbols:
    """Return the words and slots of a node, with a symbol in place of each node that has one in ``written``."""
    symbols: list[Symbol] = []
    for part in node.parts:
        if isinstance(part, Node):
            instead = written.get(id(part))
            symbols.extend((instead,) if instead else _write(part, written))
        elif isinstance(part, Text):
            symbols.append(part)
        elif part.token:
            symbols.append(bare(part))
    return tuple(symbols)


def _is_entity(phrases: Iterable[str]) -> bool:
    return all(phrase.startswith("<") and " " not in phrase for phrase in phrases)


def _words(phrases: Iterable[str]) -> frozenset[str]:
    return frozenset(word for phrase in phrases for word in phrase.split())
