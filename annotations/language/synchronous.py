"""Synchronous expansion: template × grammar → commands with their logical forms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from annotations.language.canonical import canonical_text
from annotations.language.derivations import Expander, anonymized, intact
from annotations.language.errors import LanguageError
from annotations.language.filling import fill_anonymized, fill_intact
from annotations.language.grammar import Grammar
from annotations.language.logic import Form
from annotations.language.symbols import Text, Wildcard
from annotations.language.templates import SemanticTemplate

Leaves: TypeAlias = "tuple[Text | Wildcard, ...]"


@dataclass(frozen=True, slots=True)
class Derivation:
    """One command with its wildcards intact, to be grounded.

    ``symbols`` are words and wildcards (void ones too, for their notes); ``form`` has bare
    wildcards where the command's wildcards supply a value, and no nonterminal.
    """

    symbols: Leaves
    form: Form
    template_index: int = 0

    @property
    def anonymized_text(self) -> str:
        """The command that the derivation becomes when its wildcards become class tokens."""
        return " ".join(word for symbol in self.symbols for word in anonymized(symbol))


class TemplateExpander:
    """Expands templates over one grammar; what nonterminals become is computed once and kept.

    Raises:
        LanguageError: when made of a grammar with a cycle.
    """

    def __init__(self, grammar: Grammar) -> None:
        grammar.require_finite()
        self.grammar = grammar
        self._anonymized: dict[frozenset[str], Expander[str]] = {}
        self._intact: dict[frozenset[str], Expander[Text | Wildcard]] = {}

    def size(self, template: SemanticTemplate) -> int:
        """At least the number of pairs of the template, without enumerating them."""
        return self._anonymizing(template.tracked).size(template.pattern)

    def pairs(self, template: SemanticTemplate) -> Iterator[tuple[str, str]]:
        """Streams (anonymized command, canonical form) in grammar order; repetitions may occur.

        An expansion that lacks a nonterminal of the form, because another alternative of the
        pattern has it, is left out.

        Raises:
            LanguageError: while streaming, where what stands for a predicate is no name.
        """
        tracked = template.tracked
        texts: dict[object, str] = {}
        for words, bindings in self._anonymizing(tracked).stream(template.pattern):
            if not words or len(bindings) < len(tracked):
                continue
            if bindings not in texts:
                filled = _fill_anonymized(template, dict(bindings))
                texts[bindings] = canonical_text(filled)
            yield " ".join(words), texts[bindings]

    def derivations(self, template: SemanticTemplate, index: int = 0) -> Iterator[Derivation]:
        """Streams the commands of a template with their wildcards intact; none occurs twice.

        Args:
            index: the template's number in its set, copied into each derivation.
        """
        tracked = template.tracked
        if tracked not in self._intact:
            self._intact[tracked] = Expander(self.grammar.alternatives, intact, tracked)
        seen: set[Derivation] = set()
        for leaves, bindings in self._intact[tracked].stream(template.pattern):
            if len(bindings) < len(tracked):
                continue
            derivation = Derivation(leaves, fill_intact(template.form, dict(bindings)), index)
            if derivation not in seen:
                seen.add(derivation)
                yield derivation

    def _anonymizing(self, tracked: frozenset[str]) -> Expander[str]:
        if tracked not in self._anonymized:
            self._anonymized[tracked] = Expander(self.grammar.alternatives, anonymized, tracked)
        return self._anonymized[tracked]


def _fill_anonymized(template: SemanticTemplate, bindings: dict[str, tuple[str, ...]]) -> Form:
    try:
        return fill_anonymized(template.form, bindings)
    except LanguageError as trouble:
        raise LanguageError(trouble.message, template.form_position, trouble.hint) from None
