"""All commands of a set of task categories, each with the one form it keeps (FORMATS §3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from annotations.language.derivations import readable
from annotations.language.errors import LanguageError
from annotations.language.grammar import Grammar
from annotations.language.recognizer import Recognizer
from annotations.language.synchronous import Derivation, TemplateExpander
from annotations.language.templates import SemanticTemplate

__all__ = [
    "DEFAULT_LIMIT",
    "Conflict",
    "Derivation",
    "Expansion",
    "Generated",
    "TaskCategory",
    "TemplateExpander",
    "generate",
    "generation_size",
]

DEFAULT_LIMIT = 1_000_000


@dataclass(frozen=True)
class TaskCategory:
    """A grammar and its templates, in the order in which a later one wins."""

    name: str
    grammar: Grammar
    templates: tuple[SemanticTemplate, ...]


@dataclass(frozen=True, slots=True)
class Expansion:
    """One anonymized command with its canonical form.

    ``template_index`` counts in the templates of ``task_category``, the first category that has the
    command; ``in_grammar`` says whether that category's grammar derives it too.
    """

    command: str
    form_text: str
    task_category: str
    template_index: int
    in_grammar: bool


@dataclass(frozen=True, slots=True)
class Conflict:
    """A command to which templates of one set give different forms.

    ``candidates`` are (template index, form) in the order of the templates; the last one is kept.
    """

    task_category: str
    command: str
    candidates: tuple[tuple[int, str], ...]

    @property
    def kept(self) -> str:
        return self.candidates[-1][1]


@dataclass(frozen=True, slots=True)
class Generated:
    """What a generation gives: distinct commands in order of category, template and grammar.

    ``conflicts`` are those inside each category's set. ``unmatched`` are (task category, template
    index) of templates none of whose commands, if any, is derived by the grammar of a category
    that uses the template.
    """

    expansions: tuple[Expansion, ...]
    conflicts: tuple[Conflict, ...]
    unmatched: tuple[tuple[str, int], ...]

    @property
    def outside_grammar(self) -> tuple[Expansion, ...]:
        return tuple(expansion for expansion in self.expansions if not expansion.in_grammar)


def generation_size(categories: Sequence[TaskCategory]) -> int:
    """At least the number of pairs that ``generate`` would look at, without looking at them."""
    return sum(
        TemplateExpander(category.grammar).size(template)
        for category in categories
        for template in category.templates
    )


def generate(categories: Sequence[TaskCategory], limit: int | None = DEFAULT_LIMIT) -> Generated:
    """Expands every template of every category.

    Inside a set a later template wins, and the conflict is reported; across categories a command
    belongs to the first one that has it and keeps that one's form.

    Raises:
        LanguageError: the size is above ``limit`` (nothing was expanded then), a grammar has a
            cycle, or a predicate slot became no name.
    """
    size = generation_size(categories)
    if limit is not None and size > limit:
        raise LanguageError(
            f"the templates make up to {readable(size)} commands, more than the limit of {limit:,}",
            hint="raise the limit, or use narrower patterns",
        )
    expansions: dict[str, Expansion] = {}
    expanded = [_expand(category) for category in categories]
    for each in expanded:
        for command, candidates in each.candidates.items():
            if command not in expansions:
                expansions[command] = each.expansion(command, candidates[-1])
    return Generated(
        tuple(expansions.values()),
        tuple(conflict for each in expanded for conflict in each.conflicts()),
        _unmatched(expanded),
    )


@dataclass(frozen=True, slots=True)
class _Expanded:
    """Command → the (template index, form) that gave it, distinct forms only, the last one kept."""

    category: TaskCategory
    candidates: dict[str, list[tuple[int, str]]]
    commands: tuple[tuple[str, ...], ...]
    inside: frozenset[str]

    def expansion(self, command: str, kept: tuple[int, str]) -> Expansion:
        index, form = kept
        return Expansion(command, form, self.category.name, index, command in self.inside)

    def conflicts(self) -> list[Conflict]:
        return [
            Conflict(self.category.name, command, tuple(candidates))
            for command, candidates in self.candidates.items()
            if len(candidates) > 1
        ]


def _expand(category: TaskCategory) -> _Expanded:
    expander = TemplateExpander(category.grammar)
    recognizer = Recognizer(category.grammar)
    candidates: dict[str, list[tuple[int, str]]] = {}
    commands: list[tuple[str, ...]] = []
    for index, template in enumerate(category.templates):
        forms: dict[str, set[str]] = {}
        for command, form in expander.pairs(template):
            forms.setdefault(command, set()).add(form)
        for command, alternatives in forms.items():
            # An ambiguous template has no later form; the order of the texts decides.
            for form in sorted(alternatives):
                found = [each for each in candidates.get(command, ()) if each[1] != form]
                candidates[command] = [*found, (index, form)]
        commands.append(tuple(forms))
    inside = frozenset(filter(recognizer.accepts, candidates))
    return _Expanded(category, candidates, tuple(commands), inside)


def _unmatched(expanded: Sequence[_Expanded]) -> tuple[tuple[str, int], ...]:
    """Templates that no category's grammar answers, each named by the first category that has it."""
    found: dict[SemanticTemplate, tuple[str, int]] = {}
    matched: set[SemanticTemplate] = set()
    for each in expanded:
        for index, (template, commands) in enumerate(
            zip(each.category.templates, each.commands, strict=True)
        ):
            found.setdefault(template, (each.category.name, index))
            if not each.inside.isdisjoint(commands):
                matched.add(template)
    return tuple(place for template, place in found.items() if template not in matched)
