"""Synchronous expansion: template × grammar → commands with their logical forms."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeAlias

from annotations.language.forms import Application, Form, Lambda, Text, Wildcard, canonical_text
from annotations.language.grammar import (
    MAX_WORDS,
    Budget,
    Expander,
    Grammar,
    TooManyCombinations,
    anonymized,
    intact,
)
from annotations.language.templates.bounded_cache import BoundedCache
from annotations.language.templates.composition import (
    SynchronousGrammar,
    apart,
    mark_leaves,
    names_in_order,
    number_slots,
    scope_below,
    take_marks_off,
)
from annotations.language.templates.filling import (
    Composed,
    Precedence,
    fill_anonymized,
    fill_intact,
    precedence_of,
)
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import MAX_INDEXED_BYTES, LanguageError

# The predicate of a term that stands in for an action of a line.
STAND_IN = "action of a line"
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
    """The form of a command with class tokens for its slots, and its canonical text.

    ``precedence`` says what its nonterminals became: of several forms of a command the greatest is kept. In ``own``
    one term stands in for each form of a line, so that its terms are those of the template.
    """

    form: Form
    text: str
    precedence: Precedence
    own: Form


class TemplateExpander:
    """Expands templates over one grammar; what nonterminals become is computed once and kept.

    Args:
        grammar: the productions.
        lines: what nonterminals may become, with their forms (see ``composition``).

    Raises:
        LanguageError: the grammar, or the lines, have a cycle.
    """

    def __init__(self, grammar: Grammar, lines: tuple[SemanticTemplate, ...] = ()) -> None:
        self.grammar = grammar
        self.rules = SynchronousGrammar(grammar, lines)
        self.rules.words.require_finite()
        self._anonymized: BoundedCache[frozenset[str], Expander[str]] = BoundedCache(MOST_TRACKED)
        self._intact: BoundedCache[tuple[frozenset[str], int], Expander[Text | Wildcard]] = (
            BoundedCache(MOST_TRACKED)
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
        names = names_in_order(template)
        composed = self.rules.composed(template)
        self._require_short(template)
        forms: dict[object, FilledForm] = {}
        with _place_errors(template):
            for words, bindings in self._anonymizing(tracked).stream(template.pattern, budget):
                # A line may say nothing where another part of the command does.
                if not (words or template.nonterminal) or len(bindings) < len(tracked):
                    continue
                filled = forms.get(bindings)
                if filled is None:
                    values = dict(bindings)
                    form = _filled(template, values)
                    precedence = tuple(precedence_of(values[name]) for name in names)
                    own = _filled(template, _stand_ins(values)) if composed else form
                    filled = FilledForm(form, canonical_text(form), precedence, own)
                    forms[bindings] = filled
                    budget.spend(len(filled.text))
                    _require_indexable(filled.text, "form", template)
                _require_indexable(" ".join(words), "command", template)
                yield words, filled

    def derivations(
        self, template: SemanticTemplate, index: int = 0, budget: Budget | None = None
    ) -> Iterator[Derivation]:
        """Stream the commands of a template with their wildcards intact, each only once.

        Args:
            index: the template's number in its set, copied into each derivation.

        Raises:
            TooManyCombinations: while streaming, when the budget is spent.
        """
        budget = budget or Budget()
        self._require_short(template)
        seen: set[Derivation] = set()
        with _place_errors(template):
            for leaves, form in self._with_forms(template, 0, budget):
                derivation = Derivation(leaves, form, index)
                if derivation not in seen:
                    seen.add(derivation)
                    yield derivation

    def _with_forms(
        self, template: SemanticTemplate, scope: int, budget: Budget
    ) -> Iterator[tuple[Leaves, Form]]:
        """Stream what a template or a line becomes, with its form; ``scope`` keeps the wildcards of lines apart."""
        tracked = template.tracked
        for leaves, bindings in self._keeping(template, scope).stream(template.pattern, budget):
            if len(bindings) == len(tracked):
                budget.spend(len(template.form_text) + 4 * len(leaves))
                form = fill_intact(template.form, dict(bindings))
                yield take_marks_off(leaves, form, scope)

    def _anonymizing(self, tracked: frozenset[str]) -> Expander[str]:
        composed = tracked & self.rules.lines_of.keys()
        return self._anonymized.get(
            tracked,
            lambda: Expander(
                self.rules.alternatives, anonymized, tracked, composed, self._compose_anonymized
            ),
        )

    def _compose_anonymized(
        self, name: str, budget: Budget
    ) -> Iterator[tuple[tuple[str, ...], Composed]]:
        for number, line in enumerate(self.rules.lines_of[name]):
            names = names_in_order(line)
            forms: dict[object, Composed] = {}
            for words, bindings in self._anonymizing(line.tracked).stream(line.pattern, budget):
                if len(bindings) < len(names):
                    continue
                if bindings not in forms:
                    values = dict(bindings)
                    precedence = (number, *(precedence_of(values[each]) for each in names))
                    forms[bindings] = Composed(_filled(line, values), precedence)
                yield words, forms[bindings]

    def _keeping(self, template: SemanticTemplate, scope: int) -> Expander[Text | Wildcard]:
        """Return the expander that keeps wildcards, for a template or a line with ``scope``."""
        composed = self.rules.composed(template)
        tracked = template.tracked

        def compose(name: str, budget: Budget) -> Iterator[tuple[Leaves, Composed]]:
            inner = scope_below(scope, composed.index(name))
            for number, line in enumerate(self.rules.lines_of[name]):
                for leaves, form in self._with_forms(line, inner, budget):
                    leaves, form = apart(*number_slots(leaves, form, inner), inner)
                    yield leaves, Composed(form, (number,))

        names = sorted(tracked)

        def mark(name: str, leaves: Leaves) -> Leaves:
            return mark_leaves(leaves, scope, names.index(name))

        return self._intact.get(
            (tracked, scope),
            lambda: Expander(
                self.rules.alternatives, intact, tracked, frozenset(composed), compose, mark
            ),
        )

    def _require_short(self, template: SemanticTemplate) -> None:
        words = self.rules.words.longest(template.pattern)
        if words > MAX_WORDS:
            raise LanguageError(
                f"the pattern makes commands of up to {words:,} words",
                template.position,
                f"{MAX_WORDS} is the limit; shorten the pattern",
            )


def _filled(template: SemanticTemplate, values: Mapping[str, tuple[str, ...] | Composed]) -> Form:
    """Return the form with class tokens. Raises LanguageError, at the form, where a predicate is no name."""
    try:
        return fill_anonymized(template.form, values)
    except LanguageError as error:
        raise LanguageError(error.message, template.form_position, error.hint) from None


def _stand_ins(
    values: Mapping[str, tuple[str, ...] | Composed],
) -> dict[str, tuple[str, ...] | Composed]:
    """Return the values with a term without parts, of the same kind, for each form of a line."""
    return {
        name: Composed(_stand_in(value.form), ()) if isinstance(value, Composed) else value
        for name, value in values.items()
    }


def _stand_in(form: Form) -> Form:
    if isinstance(form, Lambda):
        return Lambda(form.variable, form.type, ())
    return Application(STAND_IN) if isinstance(form, Application) else form


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
