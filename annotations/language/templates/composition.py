"""Lines ``$name -> pattern = form``: what a nonterminal may become, with the form that it gets.

Templates and lines are the rules of a synchronous grammar with λ-terms on the right (Wong and Mooney, "Learning
synchronous grammars for semantic parsing with lambda calculus", ACL 2007; Chiang, "A hierarchical
phrase-based model for statistical machine translation", ACL 2005). The productions say which commands
exist; in a template a nonterminal that has lines becomes what its lines become, and where the form mentions
it, it takes the form of the line.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

from annotations.language.forms import (
    Choice,
    Combination,
    Comparison,
    Condition,
    Form,
    Negation,
    Nonterminal,
    Symbol,
    Symbols,
    Text,
    Wildcard,
)
from annotations.language.grammar import ROOT, Grammar, Production, SententialForms
from annotations.language.templates.filling import map_slots
from annotations.language.templates.templates import SemanticTemplate

Leaves: TypeAlias = "tuple[Text | Wildcard, ...]"

# Wildcards of different lines of one command get different numbers: those of a line have so many to themselves.
_NUMBERS_OF_A_LINE = 1_000
_WITHOUT_NUMBER = 500  # from here on those that stand in the line itself and have none
_MARKS, _MARKS_OF_ONE = 600, 10  # and those in nonterminals that the form mentions
_MOST_COMPOSED = 10  # nonterminals with lines that one form mentions


@dataclass(frozen=True)
class SynchronousGrammar:
    """The productions of a task category together with the lines of its templates, in order."""

    grammar: Grammar
    lines: tuple[SemanticTemplate, ...] = ()

    @cached_property
    def lines_of(self) -> Mapping[str, tuple[SemanticTemplate, ...]]:
        """Nonterminal → its lines, in order."""
        lines: defaultdict[str, list[SemanticTemplate]] = defaultdict(list)
        for line in self.lines:
            lines[line.nonterminal].append(line)
        return {name: tuple(each) for name, each in lines.items()}

    @cached_property
    def words(self) -> Grammar:
        """What templates become: the productions, but those of a nonterminal with lines are its lines."""
        if not self.lines:
            return self.grammar
        plain = (each for each in self.grammar.productions if each.nonterminal not in self.lines_of)
        lines = (Production(each.nonterminal, each.pattern, each.position) for each in self.lines)
        return Grammar((*plain, *lines))

    def alternatives(self, name: str) -> tuple[Symbols, ...]:
        """Return the patterns of the lines of ``$name``, one each, or its alternatives in the productions."""
        if name in self.lines_of:
            return tuple(line.pattern for line in self.lines_of[name])
        return self.grammar.alternatives(name)

    def is_inside(self, template: SemanticTemplate) -> bool:
        """Return whether the productions surely derive all words that a template or a line becomes.

        They do where they derive its pattern as it is, and so the patterns of all lines below it: nothing is expanded.
        """
        spoken = self.words.spoken(template.pattern)
        names = {each.name for each in spoken if isinstance(each, Nonterminal)}
        return names.isdisjoint(self._doubtful) and self._is_derived(template)

    @cached_property
    def _doubtful(self) -> frozenset[str]:
        """The nonterminals with a line whose pattern their productions do not derive as it is."""
        return frozenset(each.nonterminal for each in self.lines if not self._is_derived(each))

    def _is_derived(self, template: SemanticTemplate) -> bool:
        return self._sentential_forms.derives(template.nonterminal or ROOT, template.pattern)

    @cached_property
    def _sentential_forms(self) -> SententialForms:
        return SententialForms(self.grammar)

    def composed(self, template: SemanticTemplate) -> tuple[str, ...]:
        """Return the nonterminals of the form that have lines, in the order of their names."""
        return tuple(sorted(template.tracked & self.lines_of.keys()))


def lines_of(templates: Iterable[SemanticTemplate]) -> tuple[SemanticTemplate, ...]:
    """Return the templates that are lines for a nonterminal."""
    return tuple(each for each in templates if each.nonterminal)


def names_in_order(template: SemanticTemplate) -> tuple[str, ...]:
    """Return the nonterminals that the form of a template mentions, each once."""
    slots = (slot for slot in template.slots() if not isinstance(slot, Wildcard))
    return tuple(dict.fromkeys(slot.name for slot in slots))


def apart(leaves: Leaves, form: Form, scope: int) -> tuple[Leaves, Form]:
    """Return what a line became with other numbers than lines with another ``scope`` have.

    A number holds within a line, together with the productions that it uses. What the lines inside became has
    numbers of its own already.
    """

    def renamed(wildcard: Wildcard) -> Wildcard:
        number = wildcard.id
        if number is not None and number < _NUMBERS_OF_A_LINE:
            number += scope * _NUMBERS_OF_A_LINE
        return replace(
            wildcard,
            id=number,
            where=wildcard.where and _in_condition(wildcard.where, renamed),
            meta=_in_symbols(wildcard.meta, renamed),
        )

    said = tuple(renamed(each) if isinstance(each, Wildcard) else each for each in leaves)
    return said, map_slots(form, renamed)


def number_slots(leaves: Leaves, form: Form, scope: int) -> tuple[Leaves, Form]:
    """Number the wildcards of a line that have no number, so that they are not taken for those of another line.

    Those of the form are the ones of the words in their order, name by name; where the form has more, they
    share the last one.
    """
    turns: Counter[str] = Counter()

    def number(wildcard: Wildcard) -> Wildcard:
        if wildcard.id is not None or not wildcard.entity_class:
            return wildcard
        turn = turns[wildcard.name]
        turns[wildcard.name] += 1
        first = scope * _NUMBERS_OF_A_LINE + _WITHOUT_NUMBER
        return replace(wildcard, id=first + min(turn, most.get(wildcard.name, turn)))

    most: dict[str, int] = {}
    numbered = tuple(number(each) if isinstance(each, Wildcard) else each for each in leaves)
    most = {name: count - 1 for name, count in turns.items()}
    turns.clear()
    return numbered, map_slots(form, number)


def mark_leaves(leaves: Leaves, scope: int, place: int) -> Leaves:
    """Number the wildcards without a number in what the nonterminal at ``place`` of a form became.

    So the form finds them again, in whatever order it mentions its nonterminals.
    """
    turns: Counter[str] = Counter()

    def mark(wildcard: Wildcard) -> Wildcard:
        if wildcard.id is not None or not wildcard.entity_class:
            return wildcard
        turns[wildcard.name] += 1
        first = scope * _NUMBERS_OF_A_LINE + _MARKS + place * _MARKS_OF_ONE
        return replace(wildcard, id=first + turns[wildcard.name])

    return tuple(mark(each) if isinstance(each, Wildcard) else each for each in leaves)


def take_marks_off(leaves: Leaves, form: Form, scope: int) -> tuple[Leaves, Form]:
    """Take the numbers of ``mark_leaves`` away where the order of the wildcards says the same.

    Wildcards of one name that have no number are those of the form in its order (``ground``).
    """
    in_command = [each for each in leaves if isinstance(each, Wildcard) and each.entity_class]
    in_form: list[Wildcard] = []

    def note(wildcard: Wildcard) -> Wildcard:
        in_form.append(wildcard)
        return wildcard

    map_slots(form, note)
    first = scope * _NUMBERS_OF_A_LINE + _MARKS
    after = (scope + 1) * _NUMBERS_OF_A_LINE

    def is_marked(wildcard: Wildcard) -> bool:
        return wildcard.id is not None and first <= wildcard.id < after

    def is_in_order(name: str) -> bool:
        said = [each for each in in_command if each.name == name and _is_free(each)]
        slots = [each for each in in_form if each.name == name and _is_free(each)]
        unmarked = [number for number, each in enumerate(said) if each.id is None]
        if not unmarked and any(slot.id is None for slot in slots):
            return True  # the form means one of those that are marked
        turns = iter(unmarked)
        meant = [said[next(turns, unmarked[-1])] if slot.id is None else slot for slot in slots]
        by_order = [said[min(turn, len(said) - 1)] for turn in range(len(slots))]
        return [each.id for each in meant] == [each.id for each in by_order]

    def _is_free(wildcard: Wildcard) -> bool:
        return wildcard.id is None or is_marked(wildcard)

    names = {each.name for each in in_command if is_marked(each)}
    plain = {name for name in names if is_in_order(name)}

    def unmark(wildcard: Wildcard) -> Wildcard:
        is_plain = wildcard.name in plain and is_marked(wildcard)
        return replace(wildcard, id=None) if is_plain else wildcard

    unmarked = tuple(unmark(each) if isinstance(each, Wildcard) else each for each in leaves)
    return unmarked, map_slots(form, unmark)


def scope_below(scope: int, place: int) -> int:
    """Return the scope of the composed nonterminal at ``place`` of a form; the scope of a template is 0."""
    return scope * _MOST_COMPOSED + place + 1


def _in_symbols(symbols: Symbols, change: Callable[[Wildcard], Wildcard]) -> Symbols:
    def changed(symbol: Symbol) -> Symbol:
        if isinstance(symbol, Choice):
            return Choice(tuple(_in_symbols(each, change) for each in symbol.alternatives))
        return change(symbol) if isinstance(symbol, Wildcard) else symbol

    return tuple(map(changed, symbols))


def _in_condition(condition: Condition, change: Callable[[Wildcard], Wildcard]) -> Condition:
    match condition:
        case Combination(operator, left, right):
            return Combination(operator, _in_condition(left, change), _in_condition(right, change))
        case Negation(operand):
            return Negation(_in_condition(operand, change))
        case Comparison(value=Wildcard() as wildcard):
            return replace(condition, value=change(wildcard))
    return condition
