"""Checks a template while somebody writes it, and shows what it would make."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import islice

from annotations.generation.kept_expansions import checker_of
from annotations.language.errors import LanguageError, Position, Problem
from annotations.language.grammar import CHECK_STEPS, Budget, Grammar
from annotations.language.limits import MAX_FORM, MAX_PATTERN, require_length
from annotations.language.predicates import gloss
from annotations.language.templates import (
    SemanticTemplate,
    TemplateChecker,
    read_sides,
)
from annotations.models import SemanticTemplate as StoredTemplate
from annotations.models import TaskCategory, World
from annotations.rows.from_rows import grammar_of, predicates_of
from annotations.rows.template_problems import StoredRemark, as_stored, from_stored

MOST_COMMANDS = 2_000  # looked at to count and sample what a template makes
SHOWN_COMMANDS = 12
MOST_CHARACTERS = {"pattern": MAX_PATTERN, "form": MAX_FORM}


@dataclass(frozen=True, slots=True)
class Checked:
    """A pattern and a form as the checker sees them.

    ``checker`` is that of the task category; None where its grammar has an error or a side is too
    long. ``commands`` are some of the distinct (command, form text) that the template makes and ``size``
    how many there are, at most ``MOST_COMMANDS``.
    """

    problems: tuple[Problem, ...]
    template: SemanticTemplate | None = None
    checker: TemplateChecker | None = None
    gloss: str = ""
    commands: tuple[tuple[str, str], ...] = ()
    size: int = 0

    @property
    def has_errors(self) -> bool:
        return any(problem.is_error for problem in self.problems)

    @property
    def is_cut(self) -> bool:
        """Whether there may be more commands than ``size``."""
        return self.size >= MOST_COMMANDS

    @property
    def stored_problems(self) -> list[StoredRemark]:
        """Return the problems as the row of a template holds them."""
        return [as_stored(problem) for problem in self.problems]


def check_template(world: World, category: TaskCategory | None, pattern: str, form: str) -> Checked:
    """Check a template for ``category`` of ``world`` and expand some of it, within ``CHECK_STEPS``."""
    too_long = tuple(_too_long(name, text) for name, text in (("pattern", pattern), ("form", form)))
    if any(too_long):
        return Checked(tuple(filter(None, too_long)))
    try:
        declared = predicates_of(world)
        grammar = grammar_of(category) if category else Grammar(())
        checker = checker_of(grammar, declared, category.name if category else "")
    except LanguageError as error:
        return Checked((error.problem,))
    template, unread = read_sides(pattern, form)
    if template is None:
        return Checked(unread, checker=checker)
    checked = Checked(checker.problems(template), template, checker, gloss(template.form, declared))
    return checked if checked.has_errors else _with_commands(checked, checker)


def recall_check(world: World, row: StoredTemplate) -> Checked:
    """Return what ``check_template`` said of ``row`` when it was saved, without expanding anything."""
    problems = tuple(from_stored(remark) for remark in row.problems)
    template, unread = read_sides(row.pattern, row.form)
    if template is None:
        return Checked(problems or unread)
    return Checked(problems, template, gloss=gloss(template.form, predicates_of(world)))


def _too_long(source: str, text: str) -> Problem | None:
    try:
        require_length(text, source, MOST_CHARACTERS[source], Position(source))
    except LanguageError as error:
        return error.problem
    return None


def _with_commands(checked: Checked, checker: TemplateChecker) -> Checked:
    pairs = checker.expander.pairs(checked.template, Budget(CHECK_STEPS))
    try:
        commands = list(dict(islice(pairs, MOST_COMMANDS)).items())
    except LanguageError as error:
        return replace(checked, problems=(*checked.problems, error.problem))
    return replace(checked, commands=tuple(commands[:SHOWN_COMMANDS]), size=len(commands))
