"""Patterns as sequences of units, so that patterns with other names and verbs can be compared."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, islice
from typing import TypeAlias

from annotations.language.forms import Choice, Nonterminal, Symbol, Symbols, Text, Wildcard
from annotations.language.grammar import Budget, Grammar
from annotations.language.texts import LanguageError

Slot: TypeAlias = "Wildcard | Nonterminal"

# A nonterminal with more expansions than this is compared by its name alone.
MOST_EXPANSIONS = 40
EXPANSION_STEPS = 5_000
MOST_UNITS = 120
_TOKEN = re.compile("<[^ ]*>")


@dataclass(frozen=True, slots=True)
class Unit:
    """A word, a slot, or a symbol with several phrases.

    ``label`` is equal for units that mean the same in any pattern: the word, the class token of a slot, or
    the phrases themselves. ``slot`` is what a form writes for it; ``phrases`` are its expansions.
    """

    label: str
    phrases: frozenset[str]
    slot: Slot | None = None

    @property
    def is_entity(self) -> bool:
        """Whether it stands for an entity, so that its label is a class token."""
        return self.label.startswith("<")


@dataclass(frozen=True)
class UnitReader:
    """Turns patterns of one grammar into units. Optional words and notes give no unit."""

    grammar: Grammar

    def units(self, pattern: Symbols) -> tuple[Unit, ...]:
        """Return at most ``MOST_UNITS`` units of a pattern, in order."""
        return tuple(islice(chain.from_iterable(map(self._of_symbol, pattern)), MOST_UNITS))

    def _of_symbol(self, symbol: Symbol) -> Iterator[Unit]:
        match symbol:
            case Text(","):
                return
            case Text(value):
                yield Unit(value.lower(), frozenset((value.lower(),)))
            case Wildcard():
                if symbol.token:
                    is_entity = bool(symbol.entity_class)
                    yield Unit(
                        symbol.token, frozenset((symbol.token,)), symbol if is_entity else None
                    )
            case Nonterminal():
                yield from self._of_nonterminal(symbol)
            case Choice():
                phrases = self.phrases(symbol)
                if phrases and "" not in phrases and not any("<" in phrase for phrase in phrases):
                    yield Unit(_label(phrases), phrases)
                else:
                    yield from self._of_longest(symbol.alternatives)

    def _of_nonterminal(self, symbol: Nonterminal) -> Iterator[Unit]:
        phrases = self.phrases(symbol)
        if phrases is None:
            yield Unit(str(symbol), frozenset((str(symbol),)), symbol)
        elif "" in phrases:
            return
        elif len(phrases) == 1 and all(map(_TOKEN.fullmatch, phrases)):
            yield Unit(_label(phrases), phrases, symbol)
        elif len(phrases) == 1 or any("<" in phrase for phrase in phrases):
            yield from self._of_longest(self.alternatives(symbol))
        else:
            yield Unit(_label(phrases), phrases, symbol)

    def _of_longest(self, alternatives: tuple[Symbols, ...]) -> Iterator[Unit]:
        yield from max((self.units(each) for each in alternatives), key=len, default=())

    def phrases(self, symbol: Nonterminal | Choice) -> frozenset[str] | None:
        """Return the anonymized expansions of a symbol, in lower case; None if they are too many."""
        if symbol not in self._known:
            expander = self.grammar.expander
            self._known[symbol] = None
            if 0 < expander.size((symbol,)) <= MOST_EXPANSIONS:
                results = expander.stream((symbol,), Budget(EXPANSION_STEPS))
                with suppress(LanguageError):
                    phrases = frozenset(" ".join(words).lower() for words, _ in results)
                    self._known[symbol] = phrases
        return self._known[symbol]

    def alternatives(self, symbol: Nonterminal | Choice) -> tuple[Symbols, ...]:
        """Return the alternatives of a symbol as they are written."""
        if isinstance(symbol, Choice):
            return symbol.alternatives
        return self.grammar.alternatives(symbol.name)

    @cached_property
    def _known(self) -> dict[Nonterminal | Choice, frozenset[str] | None]:
        return {}


def _label(phrases: frozenset[str]) -> str:
    return "|".join(sorted(phrases))
