"""Check lines for nonterminals, and the templates that take their forms (``composition``)."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from difflib import get_close_matches
from functools import lru_cache

from annotations.language.forms import (
    Application,
    Choice,
    Nonterminal,
    Symbols,
    loose_references,
    places_in_form,
    places_in_pattern,
    read_form,
    walk,
)
from annotations.language.grammar import Budget, Grammar, TooManyCombinations
from annotations.language.templates.composition import SynchronousGrammar
from annotations.language.templates.expansion import TaskCategory
from annotations.language.templates.synchronous import TemplateExpander
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import (
    LanguageError,
    Offsets,
    Problem,
    error_at,
    say_count,
    warning_at,
)

# For the phrases of all lines of a task category: about a second.
LINE_STEPS = 5_000_000
_REFERENCES = (" it ", " them ")


def composition_problems(
    template: SemanticTemplate, rules: SynchronousGrammar
) -> Iterator[Problem]:
    """Yield what is wrong with the nonterminals of a template that have lines, and with its own one if it is a line."""
    name = template.nonterminal
    if name and name not in rules.grammar.rules:
        near = get_close_matches(name, rules.grammar.rules, 1)
        yield warning_at(
            template.position,
            f"the grammar has no ${name}",
            f"did you mean ${near[0]}?" if near else f"add a production ${name} = …",
        )
    counts = _Counts(rules, frozenset(rules.composed(template)))
    for composed in rules.composed(template):
        if counts.most(template.pattern, composed) > 1:
            places = [
                each.start
                for each in places_in_pattern(template.pattern_text)
                if each.slot == Nonterminal(composed)
            ]
            yield error_at(
                template.position.shifted(places[-1] if len(places) > 1 else 0),
                f"${composed} can stand more than once in the pattern, and its lines give it a form",
                "give the second one a nonterminal of its own",
            )
    for node in walk(template.form):
        slot = node.predicate if isinstance(node, Application) else None
        if isinstance(slot, Nonterminal) and slot.name in rules.lines_of:
            places = [
                each.start for each in places_in_form(template.form_text) if each.slot == slot
            ]
            yield error_at(
                Offsets(template.form_text)
                .position(places[0] if places else 0)
                .inside(template.form_position),
                f"{slot} is used as a predicate, but its lines give it a form",
                f"write {slot} as an argument, or take its lines away",
            )


class _Counts:
    """Counts how often a nonterminal can stand in one expansion of a sequence.

    What stands in a line for another nonterminal belongs to the form of that line, and is not counted.
    """

    def __init__(self, rules: SynchronousGrammar, composed: frozenset[str]) -> None:
        self._rules = rules
        self._composed = composed
        self._known: dict[tuple[str, str], int] = {}

    def most(self, symbols: Symbols, name: str) -> int:
        return sum(self._of_symbol(symbol, name) for symbol in symbols)

    def _of_symbol(self, symbol: object, name: str) -> int:
        if isinstance(symbol, Choice):
            return max((self.most(each, name) for each in symbol.alternatives), default=0)
        if not isinstance(symbol, Nonterminal):
            return 0
        if symbol.name == name:
            return 1
        if symbol.name in self._composed:
            return 0
        key = (symbol.name, name)
        if key not in self._known:
            alternatives = self._rules.alternatives(symbol.name)
            self._known[key] = max((self.most(each, name) for each in alternatives), default=0)
        return self._known[key]


def find_loose_references(template: SemanticTemplate, texts: Collection[str]) -> Iterator[Problem]:
    """Yield a warning for each ``it`` or ``them`` in a form of a template of commands that stands for nothing.

    Args:
        texts: forms of the template, in corpus notation.
    """
    if template.nonterminal:
        return
    found: dict[str, str] = {}
    for text in texts:
        if any(word in text for word in _REFERENCES):
            for word in loose_references(read_form(text)):
                found.setdefault(word, text)
    for word, text in found.items():
        yield warning_at(
            template.form_position,
            f"“{word}” has nothing before it to stand for in {text}",
            "describe the thing or the person first",
        )


def line_problems(category: TaskCategory) -> Iterator[tuple[int, Problem]]:
    """Yield (template index, warning) of lines that no template reaches, and of those that disagree about a phrase."""
    lines = [(index, each) for index, each in enumerate(category.templates) if each.nonterminal]
    if not lines:
        return
    reached = _reached(category)
    for index, line in lines:
        if line.nonterminal not in reached:
            yield (
                index,
                warning_at(
                    line.position,
                    f"no template takes the form of ${line.nonterminal}",
                    f"mention ${line.nonterminal} in the pattern and in the form of one",
                ),
            )
    try:
        found = _disagreements(category.grammar, category.lines)
    except LanguageError:  # said of the template that has the trouble
        return
    for earlier, later, count, phrase in found:
        index, line = lines[later]
        yield (
            index,
            warning_at(
                line.position,
                f'{say_count(count, "phrase")} such as "{phrase}" with a different '
                f"form at {category.lines[earlier].position}",
                "the later form is kept; correct the one that is wrong",
            ),
        )


def _reached(category: TaskCategory) -> set[str]:
    """Return the nonterminals whose lines give a part of the form of some command."""
    waiting = [each for each in category.templates if not each.nonterminal]
    reached: set[str] = set()
    while waiting:
        new = waiting.pop().tracked - reached
        reached |= new
        waiting += (line for line in category.lines if line.nonterminal in new)
    return reached


@lru_cache(maxsize=24)
def _disagreements(
    grammar: Grammar, lines: tuple[SemanticTemplate, ...]
) -> tuple[tuple[int, int, int, str], ...]:
    """Return the pairs of lines of one nonterminal that give a phrase different forms.

    Each is the place of the earlier and of the later line, how many phrases, and the first of them.
    """
    expander = TemplateExpander(grammar, lines)
    budget = Budget(LINE_STEPS)
    first: dict[tuple[str, str], tuple[str, int]] = {}
    pairs: dict[tuple[int, int], dict[str, None]] = {}
    try:
        for place, line in enumerate(lines):
            for phrase, form in expander.pairs(line, budget):
                text, earlier = first.setdefault((line.nonterminal, phrase), (form, place))
                if text != form and earlier != place:
                    pairs.setdefault((earlier, place), {})[phrase] = None
    except TooManyCombinations:
        pass  # the other lines are not compared
    return tuple(
        (earlier, later, len(phrases), next(iter(phrases)))
        for (earlier, later), phrases in pairs.items()
    )
