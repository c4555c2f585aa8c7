"""Synchronous expansion: template × grammar → commands with their logical forms."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeAlias

from annotations.language.errors import LanguageError
from annotations.language.forms import Form, canonical_text
from annotations.language.grammar import (
    MAX_WORDS,
    Budget,
    Expander,
    Grammar,
    TooManyCombinations,
    anonymized,
    intact,
)
from annotations.language.limits import MAX_INDEXED_BYTES
from annotations.language.symbols import Text, Wildcard
from annotations.language.templates.bounded_cache import BoundedCache
from annotations.language.templates.filling import fill_anonymized, fill_intact
from annotations.language.templates.templates import SemanticTemplate

# Sets of nonterminals that forms mention, whose expansions are kept.
MOST_TRACKED = 200

Leaves: TypeAlias = "tuple[Text | Wildcard, ...]"


@dataclass(frozen=True, slots=True)
class Derivation:
    """One command with its wildcards intact, to be grounded.

    ``symbols`` are words and wildcards (also void ones, for their notes); ``form`` has bare
    wildcards where the command's wildcards supply a value, and no nonterminals.
    """

    symbols: Leaves
    form: Form
    template_index: int = 0

    @property
    def anonymized_text(self) -> str:
        """The command that the derivation becomes when its wildcards become class tokens."""
        return " ".join(word for symbol in self.symbols for word in anonymized(symbol))


@dataclass(frozen=True, slots=True)
class FilledForm:
    """The form of a command with class tokens for its slots, and its canonical text."""

    form: Form
    text: str


class TemplateExpander:
    """Expands templates over one grammar; what nonterminals become is computed once and kept.

    Raises:
        LanguageError: the grammar has a cycle.
    """

    def __init__(self, grammar: Grammar) -> None:
        grammar.require_finite()
        self.grammar = grammar
        self._anonymized: BoundedCache[frozenset[str], Expander[str]] = BoundedCache(MOST_TRACKED)
        self._intact: BoundedCache[frozenset[str], Expander[Text | Wildcard]] = BoundedCache(
            MOST_TRACKED
        )

    def size(self, template: SemanticTemplate) -> int:
        """Return an upper bound on the number of pairs of the template, without enumeration.

        Raises:
            LanguageError: one of its commands could have more than ``MAX_WORDS`` words.
        """
        self._require_short(template)
        return self._anonymizing(template.tracked).size(template.pattern)

    def pairs(
        self, template: SemanticTemplate, budget: Budget | None = None
    ) -> Iterator[tuple[str, str]]:
        """Stream (anonymized command, canonical form) in grammar order; a pair may occur more than once.

        An expansion that lacks a nonterminal of the form, because another alternative of the
        pattern has it, is left out.

        Raises:
            TooManyCombinations: while streaming, when the budget is spent.
            LanguageError: while streaming, where a command could have more than ``MAX_WORDS`` words,
                a text is too long to be stored, or the words for a predicate are not a name.
        """
        for words, filled in self.filled_pairs(template, budget):
            yield " ".join(words), filled.text

    def filled_pairs(
        self, template: SemanticTemplate, budget: Budget | None = None
    ) -> Iterator[tuple[tuple[str, ...], FilledForm]]:
        """Stream pairs like ``pairs``, as separate words and with the form as a value too."""
        tracked, budget = template.tracked, budget or Budget()
        self._require_short(template)
        forms: dict[object, FilledForm] = {}
        with _place_errors(template):
            for words, bindings in self._anonymizing(tracked).stream(template.pattern, budget):
                if not words or len(bindings) < len(tracked):
                    continue
                if bindings not in forms:
                    try:
                        form = fill_anonymized(template.form, dict(bindings))
                    except LanguageError as error:
                        place = template.form_position
                        raise LanguageError(error.message, place, error.hint) from None
                    forms[bindings] = FilledForm(form, canonical_text(form))
                    budget.spend(len(forms[bindings].text))
                    _require_indexable(forms[bindings].text, "form", template)
                _require_indexable(" ".join(words), "command", template)
                yield words, forms[bindings]

    def derivations(
        self, template: SemanticTemplate, index: int = 0, budget: Budget | None = None
    ) -> Iterator[Derivation]:
        """Stream the commands of a template with their wildcards intact, each only once.

        Args:
            index: the template's number in its set, copied into each derivation.

        Raises:
            TooManyCombinations: while streaming, when the budget is spent.
        """
        tracked, budget = template.tracked, budget or Budget()
        self._require_short(template)
        expander = self._intact.get(
            tracked, lambda: Expander(self.grammar.alternatives, intact, tracked)
        )
        seen: set[Derivation] = set()
        with _place_errors(template):
            for leaves, bindings in expander.stream(template.pattern, budget):
                if len(bindings) < len(tracked):
                    continue
                budget.spend(len(template.form_text) + 4 * len(leaves))
                derivation = Derivation(leaves, fill_intact(template.form, dict(bindings)), index)
                if derivation not in seen:
                    seen.add(derivation)
                    yield derivation

    def _require_short(self, template: SemanticTemplate) -> None:
        words = self.grammar.longest(template.pattern)
        if words > MAX_WORDS:
            raise LanguageError(
                f"the pattern makes commands of up to {words:,} words",
                template.position,
                f"{MAX_WORDS} is the limit; shorten the pattern",
            )

    def _anonymizing(self, tracked: frozenset[str]) -> Expander[str]:
        return self._anonymized.get(
            tracked, lambda: Expander(self.grammar.alternatives, anonymized, tracked)
        )


@contextmanager
def _place_errors(template: SemanticTemplate) -> Iterator[None]:
    """Give TooManyCombinations the position of the template whose expansion spent the budget."""
    try:
        yield
    except TooManyCombinations as error:
        raise TooManyCombinations(error.message, template.position, error.hint) from None


def _require_indexable(text: str, what: str, template: SemanticTemplate) -> None:
    size = len(text.encode())
    if size > MAX_INDEXED_BYTES:
        raise LanguageError(
            f"a {what} of the template has {size:,} bytes",
            template.position,
            f"{MAX_INDEXED_BYTES:,} is the limit; shorten the pattern and the form",
        )
