"""Generate all commands of task categories, each with the one form it keeps (docs/reference/formats.md, Templates)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from annotations.language.grammar import Budget, Grammar, TooManyCombinations, readable
from annotations.language.templates.composition import lines_of
from annotations.language.templates.grammar_expansions import (
    DEFAULT_LIMIT,
    GrammarExpansions,
    too_many_commands,
)
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import LanguageError, Problem

# A command of the 2019 grammar takes 40; discarded combinations count too.
STEPS_PER_COMMAND = 200

# A grammar and the lines of its nonterminals → what templates expand to.
ExpansionsOf: TypeAlias = Callable[[Grammar, tuple[SemanticTemplate, ...]], GrammarExpansions]


@dataclass(frozen=True)
class TaskCategory:
    """A grammar and its templates, in order; a later template wins.

    Some of the templates are lines, which say what a nonterminal becomes in the others.
    """

    name: str
    grammar: Grammar
    templates: tuple[SemanticTemplate, ...]

    @property
    def lines(self) -> tuple[SemanticTemplate, ...]:
        """The templates that are lines for a nonterminal."""
        return lines_of(self.templates)


@dataclass(frozen=True, slots=True)
class Expansion:
    """One anonymized command with its canonical form.

    ``template_index`` is the place in the templates of ``task_category``, the first category that
    has the command; ``in_grammar`` says whether that category's grammar derives it too.
    """

    command: str
    form_text: str
    task_category: str
    template_index: int
    in_grammar: bool


@dataclass(frozen=True, slots=True)
class Conflict:
    """A command to which templates of one task category give different forms.

    ``candidates`` are (template index, form) in the order of the templates; the last one is kept.
    """

    task_category: str
    command: str
    candidates: tuple[tuple[int, str], ...]

    @property
    def kept(self) -> str:
        return self.candidates[-1][1]


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A template that is left out because of ``problem``: too many commands, or one that cannot be stored."""

    task_category: str
    template_index: int
    problem: Problem


@dataclass(frozen=True, slots=True)
class Generated:
    """The result of ``generate``: distinct commands in order of category, template and grammar.

    ``conflicts`` are those inside each category. ``unmatched`` are (task category, template index)
    of templates without a command that the grammar of a category with this template derives.
    ``commands_by_template`` are what each template makes, whichever template wins them.
    """

    expansions: tuple[Expansion, ...]
    conflicts: tuple[Conflict, ...]
    unmatched: tuple[tuple[str, int], ...]
    left_out: tuple[LeftOut, ...] = ()
    commands_by_template: Mapping[tuple[str, int], Collection[str]] = field(
        default_factory=dict, compare=False, repr=False
    )

    @property
    def outside_grammar(self) -> tuple[Expansion, ...]:
        return tuple(expansion for expansion in self.expansions if not expansion.in_grammar)


def generation_size(
    categories: Sequence[TaskCategory],
    limit: int | None = DEFAULT_LIMIT,
    expansions: ExpansionsOf = GrammarExpansions,
) -> int:
    """Return an upper bound on the number of pairs that ``generate`` looks at, without enumeration.

    Raises:
        LanguageError: a grammar has a cycle.
    """
    return sum(each.size for each in _choose(categories, limit, expansions))


def generate(
    categories: Sequence[TaskCategory],
    limit: int | None = DEFAULT_LIMIT,
    expansions: ExpansionsOf = GrammarExpansions,
    budget: Budget | None = None,
) -> Generated:
    """Expand every template of every category.

    Inside a category a later template wins, and the conflict is reported. A command of several
    categories belongs to the first one and keeps its form from there. A template that makes more than
    ``limit`` commands by itself, or one that cannot be stored, is left out.

    Args:
        expansions: gives the kept expansions of a grammar; nothing is kept by default.
        budget: for what is expanded anew; ``STEPS_PER_COMMAND`` times ``limit`` steps by default.

    Raises:
        LanguageError: the size of the others is above ``limit`` (then nothing is expanded), or a
            grammar has a cycle.
        TooManyCombinations: the budget is spent.
    """
    chosen = _choose(categories, limit, expansions)
    size = sum(each.size for each in chosen)
    if limit is not None and size > limit:
        raise LanguageError(
            f"the templates make up to {readable(size)} commands, more than the limit of {limit:,}",
            hint="raise the limit, or use narrower patterns",
        )
    budget = budget or Budget(None if limit is None else limit * STEPS_PER_COMMAND)
    expanded = [_expand(each, budget) for each in chosen]
    distinct: dict[str, Expansion] = {}  # as the first category that has the command expands it
    for result in expanded:
        for command in result.candidates:
            if command not in distinct:
                distinct[command] = result.expansion(command)
    return Generated(
        tuple(distinct.values()),
        tuple(conflict for result in expanded for conflict in result.conflicts()),
        _find_unmatched(expanded),
        tuple(left for result in chosen for left in result.left_out),
        {
            (result.category.name, index): commands
            for result in expanded
            for index, commands in result.commands.items()
        },
    )


def _choose(
    categories: Sequence[TaskCategory], limit: int | None, expansions: ExpansionsOf
) -> list[_Chosen]:
    return [
        _Chosen(expansions(category.grammar, category.lines), category, limit)
        for category in categories
    ]


class _Chosen:
    """The templates of a category that are small enough to be expanded, and those left out."""

    def __init__(
        self, expansions: GrammarExpansions, category: TaskCategory, limit: int | None
    ) -> None:
        self.expansions = expansions
        self.category = category
        self.size = 0
        self.left_out: list[LeftOut] = []
        self.indexes: list[int] = []
        for index, template in enumerate(category.templates):
            if template.nonterminal:
                continue
            try:
                size = expansions.size(template)
            except LanguageError as error:
                self.leave_out(index, error.problem)
                continue
            if problem := too_many_commands(template, size, limit):
                self.leave_out(index, problem)
            else:
                self.size += size
                self.indexes.append(index)

    def leave_out(self, index: int, problem: Problem) -> None:
        self.left_out.append(LeftOut(self.category.name, index, problem))


@dataclass(frozen=True, slots=True)
class _Expanded:
    """Command → its distinct forms with the index of the last template that gave each; the last wins.

    ``commands`` are those of each template by its index.
    """

    category: TaskCategory
    candidates: dict[str, dict[str, int]]
    commands: dict[int, Collection[str]]
    inside: frozenset[str]

    def expansion(self, command: str) -> Expansion:
        form, index = next(reversed(self.candidates[command].items()))
        return Expansion(command, form, self.category.name, index, command in self.inside)

    def conflicts(self) -> list[Conflict]:
        return [
            Conflict(
                self.category.name, command, tuple((index, form) for form, index in forms.items())
            )
            for command, forms in self.candidates.items()
            if len(forms) > 1
        ]


def _expand(chosen: _Chosen, budget: Budget) -> _Expanded:
    category = chosen.category
    candidates: dict[str, dict[str, int]] = {}
    commands: dict[int, Collection[str]] = {}
    for index in chosen.indexes:
        try:
            pairs = chosen.expansions.pairs(category.templates[index], budget)
        except TooManyCombinations:
            raise
        except LanguageError as error:
            chosen.leave_out(index, error.problem)
            continue
        for command, alternatives in pairs.items():
            kept = candidates.setdefault(command, {})
            for form in alternatives:
                kept.pop(form, None)
                kept[form] = index
        commands[index] = pairs.keys()
    rules = chosen.expansions.expander.rules
    sure = frozenset().union(
        *(commands[index] for index in commands if rules.is_inside(category.templates[index]))
    )
    inside = sure | chosen.expansions.derived(candidates.keys() - sure, budget)
    return _Expanded(category, candidates, commands, inside)


def _find_unmatched(expanded: Sequence[_Expanded]) -> tuple[tuple[str, int], ...]:
    """Return templates whose commands no category's grammar derives, each with its first category."""
    places: dict[SemanticTemplate, tuple[str, int]] = {}
    matched: set[SemanticTemplate] = set()
    for result in expanded:
        for index, commands in result.commands.items():
            template = result.category.templates[index]
            places.setdefault(template, (result.category.name, index))
            if not result.inside.isdisjoint(commands):
                matched.add(template)
    return tuple(place for template, place in places.items() if template not in matched)
