"""What can be said of a template while somebody writes it, and what it would make."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import islice
from typing import Any

from annotations.language.errors import LanguageError, Position, Problem
from annotations.language.expansion import TemplateExpander
from annotations.language.form_printing import to_reading
from annotations.language.grammar import Grammar
from annotations.language.predicates import gloss
from annotations.language.template_problems import template_checker
from annotations.language.templates import SemanticTemplate, make_template
from annotations.models import TaskCategory, World
from annotations.reading import grammar_of, predicates_of

MOST_COMMANDS = 2_000  # looked at to count and sample what a template makes
SHOWN_COMMANDS = 12


@dataclass(frozen=True, slots=True)
class Checked:
    """A pattern and a form as the checker sees them.

    ``commands`` are some of the distinct (command, form text) that the template makes and ``size``
    how many there are, at most ``MOST_COMMANDS``.
    """

    problems: tuple[Problem, ...]
    template: SemanticTemplate | None = None
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

    def as_json(self) -> dict[str, Any]:
        """What the editor asks for: problems by field with their place, the reading, the gloss."""
        reading = to_reading(self.template.form) if self.template else ""
        found = [_problem_json(problem) for problem in self.problems]
        return {"problems": found, "reading": reading, "gloss": self.gloss}


def check_template(world: World, category: TaskCategory | None, pattern: str, form: str) -> Checked:
    """Checks a template for ``category`` of ``world`` and expands some of it."""
    try:
        template, unread = _read(pattern.strip(), form.strip())
        if template is None:
            return Checked(unread)
        declared = predicates_of(world)
        grammar = grammar_of(category) if category else Grammar(())
        found = template_checker(grammar, declared).problems(template)
        checked = Checked(found, template, gloss(template.form, declared))
        return checked if checked.has_errors else _with_commands(checked, grammar)
    except LanguageError as error:
        return Checked((error.problem,))


def _read(pattern: str, form: str) -> tuple[SemanticTemplate | None, tuple[Problem, ...]]:
    """The template, or what keeps each of its sides from being read."""
    sides = (("pattern", pattern, "UNKNOWN"), ("form", "anything", form))
    found = [_unreadable(*side) for side in sides]
    problems = tuple(problem for problem in found if problem)
    if problems:
        return None, problems
    template = make_template(pattern, form, Position("pattern"))
    return replace(template, form_position=Position("form")), ()


def _unreadable(source: str, pattern: str, form: str) -> Problem | None:
    try:
        make_template(pattern, form, Position(source))
    except LanguageError as error:
        return error.problem
    return None


def _with_commands(checked: Checked, grammar: Grammar) -> Checked:
    pairs = TemplateExpander(grammar).pairs(checked.template)
    found = list(dict(islice(pairs, MOST_COMMANDS)).items())
    return replace(checked, commands=tuple(found[:SHOWN_COMMANDS]), size=len(found))


def _problem_json(problem: Problem) -> dict[str, Any]:
    return {
        "field": "form" if problem.position.source == "form" else "pattern",
        "line": problem.position.line,
        "column": problem.position.column,
        "severity": str(problem.severity),
        "message": problem.message,
        "hint": problem.hint,
    }
