"""Expand templates over one grammar and recognise the commands of the grammar, each only once."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

from annotations.language.forms import Form
from annotations.language.grammar import Budget, Grammar, Recognizer, readable, recognizer_of
from annotations.language.templates.bounded_cache import BoundedCache
from annotations.language.templates.filling import Precedence
from annotations.language.templates.synchronous import TemplateExpander
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import LanguageError, Problem, warning_at

# Command → its forms, the one to keep last; more than one where a template is ambiguous.
Pairs: TypeAlias = Mapping[str, tuple[str, ...]]


@dataclass(frozen=True, slots=True)
class TemplatePairs:
    """The pairs of a template. ``n_pairs`` counts repetitions, ``steps`` the work.

    ``own_forms`` are distinct, with one term in place of the form of a line (``FilledForm.own``).
    """

    pairs: Pairs
    own_forms: tuple[Form, ...]
    n_pairs: int
    steps: int

    def __len__(self) -> int:
        return len(self.pairs)


# A template that makes more commands than this by itself is left out.
DEFAULT_LIMIT = 1_000_000

# A grammar with more commands than this is never enumerated, and its commands are recognised singly.
MOST_ENUMERATED = 50_000
ENUMERATION_STEPS = 5_000_000
# Recognising one command takes as long as enumerating so many.
ENUMERATED_FOR_ONE = 15


class GrammarExpansions:
    """Expands templates over one grammar and keeps what they made.

    Several threads may share one: kept values never change, and two that are made at once are equal.

    Args:
        lines: what nonterminals may become, with their forms.
        most_kept: how many pairs to keep; those of the least recently used templates go first.

    Raises:
        LanguageError: the grammar has a cycle.
    """

    def __init__(
        self, grammar: Grammar, lines: tuple[SemanticTemplate, ...] = (), most_kept: int = 0
    ) -> None:
        self.grammar = grammar
        self.expander = TemplateExpander(grammar, lines)
        self._kept: BoundedCache[tuple[str, str], TemplatePairs] = BoundedCache(most_kept, len)
        self._sizes: BoundedCache[tuple[str, str], int] = BoundedCache(most_kept)

    def size(self, template: SemanticTemplate) -> int:
        """Return an upper bound on the number of pairs of the template. Raises as ``TemplateExpander.size``."""
        return self._sizes.get(template.texts, lambda: self.expander.size(template))

    def has(self, template: SemanticTemplate) -> bool:
        """Return whether the pairs of the template are here already."""
        return template.texts in self._kept

    def pairs(self, template: SemanticTemplate, budget: Budget) -> Pairs:
        """Return the distinct commands of the template in grammar order, with their forms.

        Raises:
            TooManyCombinations: the budget is spent.
            LanguageError: as ``TemplateExpander.pairs``.
        """
        return self.made(template, budget).pairs

    def made(self, template: SemanticTemplate, budget: Budget) -> TemplatePairs:
        """Return everything that the template makes. Raises as ``pairs``."""
        return self._kept.get(template.texts, lambda: _collect(self.expander, template, budget))

    def derived(self, commands: Collection[str], budget: Budget) -> frozenset[str]:
        """Return those of ``commands`` that the grammar derives.

        Raises:
            TooManyCombinations: the budget is spent.
        """
        is_enumerated = "commands" in self.__dict__
        worth = min(MOST_ENUMERATED, ENUMERATED_FOR_ONE * len(commands))
        if (is_enumerated or self.grammar.size() <= worth) and self.commands is not None:
            return self._command_set.intersection(commands)
        return frozenset(each for each in commands if self._recognizer.accepts(each, budget))

    def accepts(self, command: str, budget: Budget | None = None) -> bool:
        """Return whether the grammar derives ``command``. Raises TooManyCombinations."""
        return bool(self.derived((command,), budget or Budget()))

    @cached_property
    def commands(self) -> tuple[str, ...] | None:
        """The distinct commands of the grammar in its order; None where it has too many to look at."""
        try:
            if self.grammar.size() > MOST_ENUMERATED:
                return None
            return tuple(self.grammar.commands(budget=Budget(ENUMERATION_STEPS)))
        except LanguageError:
            return None

    @cached_property
    def _command_set(self) -> frozenset[str]:
        return frozenset(self.commands or ())

    @cached_property
    def _recognizer(self) -> Recognizer:
        return recognizer_of(self.grammar)


def _collect(
    expander: TemplateExpander, template: SemanticTemplate, budget: Budget
) -> TemplatePairs:
    before, count = budget.spent, 0
    commands: dict[str, dict[str, Precedence]] = {}
    forms: dict[Form, None] = {}
    for words, filled in expander.filled_pairs(template, budget):
        found = commands.setdefault(" ".join(words), {})
        found[filled.text] = max(filled.precedence, found.get(filled.text, filled.precedence))
        forms[filled.own] = None
        count += 1
    pairs = {
        command: tuple(sorted(found, key=found.__getitem__)) for command, found in commands.items()
    }
    return TemplatePairs(pairs, tuple(forms), count, budget.spent - before)


def too_many_commands(template: SemanticTemplate, size: int, limit: int | None) -> Problem | None:
    """Return the warning about a template that makes more than ``limit`` commands by itself."""
    if limit is None or size <= limit:
        return None
    return warning_at(
        template.position,
        f"the pattern makes up to {readable(size)} commands, more than the limit of {limit:,}; "
        "the template is left out",
        "narrow the pattern, or draw a sample of the commands",
    )
