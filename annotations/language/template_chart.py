"""Which template derives this command, and with which form: the paper's grammar oracle.

Patterns of templates are rules of the same chart as the grammar (``recognizer``), so a grammar of
10¹² commands parses a sentence without being enumerated.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from annotations.language.canonical import canonical_text
from annotations.language.errors import LanguageError
from annotations.language.expansion import TaskCategory
from annotations.language.filling import fill_anonymized
from annotations.language.recognizer import Alternative, Chart, Item, RuleBook
from annotations.language.templates import SemanticTemplate

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
        LanguageError: when made of a grammar with a cycle.
    """

    def __init__(self, categories: Sequence[TaskCategory]) -> None:
        self._sets = [_TemplateSet(category) for category in categories]

    def parse(self, command: str) -> list[ChartDerivation]:
        """All derivations of a command, given as words between spaces; the one to keep first.

        Categories come in their order and, inside one, later templates first, which is how
        ``generate`` resolves conflicts. Empty where no template derives the command.
        """
        words = tuple(command.split())
        found = (derivation for each in self._sets for derivation in each.parse(words))
        return list(dict.fromkeys(found))


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
            rule, template = self.rules[index], self.category.templates[index]
            if len(words) not in chart.ends(rule, 0):
                continue
            forms = {
                self._form(index, template, bindings)
                for bindings in _bindings(chart, rule, template.tracked)
            }
            for form in sorted(forms - {""}, reverse=True):
                yield ChartDerivation(form, self.category.name, index)

    def _form(self, index: int, template: SemanticTemplate, bindings: Bindings) -> str:
        """The canonical form; empty where a slot of it is missing or cannot be filled."""
        key = (index, bindings)
        if key not in self._forms:
            self._forms[key] = _filled(template, bindings)
        return self._forms[key]


def _filled(template: SemanticTemplate, bindings: Bindings) -> str:
    if len(bindings) < len(template.tracked):
        return ""
    try:
        return canonical_text(fill_anonymized(template.form, dict(bindings)))
    except LanguageError:
        return ""


def _bindings(chart: Chart, rule: int, tracked: frozenset[str]) -> list[Bindings]:
    """What the tracked nonterminals can be when ``rule`` derives the whole command."""
    if not tracked:
        return [()]
    return list(_Unifier(chart, tracked).of_rule(rule, 0, len(chart.words)))


class _Unifier:
    """Collects bindings over a filled chart; occurrences of one nonterminal must agree."""

    def __init__(self, chart: Chart, tracked: frozenset[str]) -> None:
        self.chart = chart
        self.tracked = tracked
        self._known: dict[tuple[int, int, int], dict[Bindings, None]] = {}

    def of_rule(self, rule: int, start: int, end: int) -> dict[Bindings, None]:
        """The distinct bindings of a rule that spans the words from ``start`` to ``end``."""
        key = (rule, start, end)
        if key not in self._known:
            self._known[key] = self._computed(rule, start, end)
        return self._known[key]

    def _computed(self, rule: int, start: int, end: int) -> dict[Bindings, None]:
        described = self.chart.rules[rule]
        if self.tracked.isdisjoint(described.names):
            return {(): None}
        found: dict[Bindings, None] = {}
        for alternative in self.chart.candidates(rule, start):
            found.update(self._of_alternative(alternative, start, end))
        if described.name in self.tracked:
            own = ((described.name, self.chart.words[start:end]),)
            joined = (_united(bindings, own) for bindings in found)
            found = {bindings: None for bindings in joined if bindings is not None}
        return found

    def _of_alternative(
        self, alternative: Alternative, start: int, end: int
    ) -> dict[Bindings, None]:
        reached: dict[int, dict[Bindings, None]] = {start: {(): None}}
        for item in alternative:
            following: dict[int, dict[Bindings, None]] = {}
            for place, bindings in reached.items():
                for stop in self.chart.ends(item, place):
                    if stop <= end:
                        inner = self._of_item(item, place, stop)
                        following.setdefault(stop, {}).update(_products(bindings, inner))
            reached = following
        return reached.get(end, {})

    def _of_item(self, item: Item, start: int, end: int) -> dict[Bindings, None]:
        return {(): None} if isinstance(item, tuple) else self.of_rule(item, start, end)


def _products(left: dict[Bindings, None], right: dict[Bindings, None]) -> dict[Bindings, None]:
    joined = (_united(one, other) for one in left for other in right)
    return {bindings: None for bindings in joined if bindings is not None}


def _united(one: Bindings, other: Bindings) -> Bindings | None:
    """Both together, or None where they disagree about a nonterminal."""
    if not one or not other:
        return one or other
    merged = dict(one)
    for name, words in other:
        if merged.setdefault(name, words) != words:
            return None
    return tuple(sorted(merged.items()))
