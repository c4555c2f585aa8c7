"""Find the templates that derive a command, with their forms: the paper's grammar oracle.

Patterns of templates are rules of the same chart as the grammar (``recognizer``), so a grammar of
10¹² commands parses a sentence without being enumerated.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from annotations.language.errors import LanguageError
from annotations.language.forms import canonical_text
from annotations.language.grammar import (
    CHECK_STEPS,
    Alternative,
    Budget,
    Chart,
    RuleBook,
    TooManyCombinations,
)
from annotations.language.templates.expansion import TaskCategory
from annotations.language.templates.filling import fill_anonymized
from annotations.language.templates.templates import SemanticTemplate

# What work costs in steps of a budget: filling a form and printing it; uniting two sets of bindings.
STEPS_PER_FORM, STEPS_PER_UNION = 300, 10

# Sorted (nonterminal, words) pairs.
Words = tuple[str, ...]
Bindings = tuple[tuple[str, Words], ...]


@dataclass(frozen=True, slots=True)
class ChartDerivation:
    """One way to derive a command: the template of a task category and the form it gives."""

    form_text: str
    task_category: str
    template_index: int


class TemplateChart:
    """Parses anonymized commands with the templates of task categories.

    Raises:
        LanguageError: the grammar has a cycle.
    """

    def __init__(self, categories: Sequence[TaskCategory]) -> None:
        self._sets = [_TemplateSet(category) for category in categories]

    def parse(self, command: str) -> list[ChartDerivation]:
        """Return all derivations of a command, given as words between spaces; the one to keep is first.

        Categories come in their order and, inside one, later templates first, which is how
        ``generate`` resolves conflicts. Empty if no template derives the command. A template whose
        slots can be read in too many ways is skipped.
        """
        words = tuple(command.split())
        derivations = (derivation for each in self._sets for derivation in each.parse(words))
        return list(dict.fromkeys(derivations))


class _TemplateSet:
    def __init__(self, category: TaskCategory) -> None:
        self.category = category
        self.book = RuleBook(category.grammar.expander)
        self.rules = [self.book.add_pattern(each.pattern) for each in category.templates]
        self._forms: dict[tuple[int, Bindings], str] = {}

    def parse(self, words: Words) -> Iterator[ChartDerivation]:
        if not words:
            return
        chart = Chart(self.book, words)
        for index in range(len(self.rules) - 1, -1, -1):
            if len(words) not in chart.ends(self.rules[index], 0):
                continue
            try:
                forms = self._forms_of(index, chart)
            except TooManyCombinations:
                continue
            for form in sorted(forms - {""}, reverse=True):
                yield ChartDerivation(form, self.category.name, index)

    def _forms_of(self, index: int, chart: Chart) -> set[str]:
        template, budget = self.category.templates[index], Budget(CHECK_STEPS)
        forms = set()
        possible: Iterable[Bindings] = ((),)
        if template.tracked:
            unifier = _Unifier(chart, template.tracked, budget)
            possible = unifier.of_rule(self.rules[index], 0, len(chart.words))
        for bindings in possible:
            budget.spend(STEPS_PER_FORM)
            key = (index, bindings)
            if key not in self._forms:
                self._forms[key] = _fill_text(template, bindings)
            forms.add(self._forms[key])
        return forms


def _fill_text(template: SemanticTemplate, bindings: Bindings) -> str:
    if len(bindings) < len(template.tracked):
        return ""
    try:
        return canonical_text(fill_anonymized(template.form, dict(bindings)))
    except LanguageError:
        return ""


class _Unifier:
    """Collects bindings over a filled chart; occurrences of one nonterminal must agree."""

    def __init__(self, chart: Chart, tracked: frozenset[str], budget: Budget) -> None:
        self.chart = chart
        self.tracked = tracked
        self.budget = budget
        self._known: dict[tuple[int, int, int], dict[Bindings, None]] = {}

    def of_rule(self, rule: int, start: int, end: int) -> dict[Bindings, None]:
        """Return the distinct bindings of a rule that spans the words from ``start`` to ``end``."""
        key = (rule, start, end)
        if key in self._known:
            return self._known[key]
        described = self.chart.rules[rule]
        results: dict[Bindings, None] = {}
        if self.tracked.isdisjoint(described.names):
            results[()] = None
        else:
            for alternative in self.chart.candidates(rule, start):
                results.update(self._of_alternative(alternative, start, end))
            if described.name in self.tracked:
                own = ((described.name, self.chart.words[start:end]),)
                joined = (_unite(bindings, own) for bindings in results)
                results = {bindings: None for bindings in joined if bindings is not None}
        self._known[key] = results
        return results

    def _of_alternative(
        self, alternative: Alternative, start: int, end: int
    ) -> dict[Bindings, None]:
        reached: dict[int, dict[Bindings, None]] = {start: {(): None}}
        for item in alternative:
            following: dict[int, dict[Bindings, None]] = {}
            for place, bindings in reached.items():
                for stop in self.chart.ends(item, place):
                    if stop <= end:
                        inner: dict[Bindings, None] = {(): None}
                        if not isinstance(item, tuple):
                            inner = self.of_rule(item, place, stop)
                        self.budget.spend(STEPS_PER_UNION * len(bindings) * len(inner))
                        joined = (_unite(one, other) for one in bindings for other in inner)
                        united = {each: None for each in joined if each is not None}
                        following.setdefault(stop, {}).update(united)
            reached = following
        return reached.get(end, {})


def _unite(one: Bindings, other: Bindings) -> Bindings | None:
    """Merge two sets of bindings, or return None if they disagree about a nonterminal."""
    if not one or not other:
        return one or other
    merged = dict(one)
    for name, words in other:
        if merged.setdefault(name, words) != words:
            return None
    return tuple(sorted(merged.items()))
