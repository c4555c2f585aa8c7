"""Check a template while somebody writes it, and show what it would make."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import islice
from random import Random

from annotations.generation.kept_expansions import checker_of
from annotations.language.grammar import CHECK_STEPS, Budget, Grammar
from annotations.language.grounding import ground
from annotations.language.templates import (
    Derivation,
    SemanticTemplate,
    TemplateChecker,
    read_known_sides,
)
from annotations.language.texts import (
    MAX_FORM,
    MAX_PATTERN,
    LanguageError,
    Position,
    Problem,
    require_length,
)
from annotations.language.world import gloss
from annotations.models import SemanticTemplate as StoredTemplate
from annotations.models import TaskCategory, World
from annotations.rows.from_rows import (
    classes_of,
    composition_of,
    grammar_of,
    ontology_of,
    predicates_of,
)
from annotations.rows.stored_problems import StoredRemark, as_stored, from_stored

MOST_COMMANDS = 2_000  # looked at to count and sample what a template makes
SHOWN_COMMANDS = 12
MOST_CHARACTERS = {"pattern": MAX_PATTERN, "form": MAX_FORM}
SHOWN_SAMPLES = 5
MOST_DERIVATIONS = 500  # that samples are drawn from
LARGEST_SEED = 2**31


@dataclass(frozen=True, slots=True)
class CheckedTemplate:
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


def check_template(
    world: World, category: TaskCategory | None, pattern: str, form: str
) -> CheckedTemplate:
    """Check a template for ``category`` of ``world`` and expand some of it, within ``CHECK_STEPS``."""
    too_long: list[Problem] = []
    for field, text in (("pattern", pattern), ("form", form)):
        try:
            require_length(text, field, MOST_CHARACTERS[field], Position(field))
        except LanguageError as error:
            too_long.append(error.problem)
    if too_long:
        return CheckedTemplate(tuple(too_long))
    classes = classes_of(world)
    template, unread = read_known_sides(pattern, form, classes)
    try:
        declared = predicates_of(world)
        grammar = grammar_of(category) if category else Grammar(())
        lines = composition_of(category) if category else ()
        if template is not None and template.nonterminal:
            lines = (*lines, template)  # it may close a cycle
        name = category.name if category else ""
        checker = checker_of(grammar, declared, name, lines, world.most_of_a_template)
    except LanguageError as error:
        return CheckedTemplate((error.problem,))
    if template is None:
        return CheckedTemplate(unread, checker=checker)
    checked = CheckedTemplate(
        checker.problems(template), template, checker, gloss(template.form, declared, classes)
    )
    if checked.has_errors:
        return checked
    pairs = checker.expander.pairs(template, Budget(CHECK_STEPS))
    try:
        commands = list(dict(islice(pairs, MOST_COMMANDS)).items())
    except LanguageError as error:
        return replace(checked, problems=(*checked.problems, error.problem))
    return replace(checked, commands=tuple(commands[:SHOWN_COMMANDS]), size=len(commands))


def recall_check(world: World, row: StoredTemplate) -> CheckedTemplate:
    """Return what ``check_template`` said of ``row`` when it was saved, without expanding anything."""
    problems = tuple(from_stored(remark) for remark in row.problems)
    classes = classes_of(world)
    template, unread = read_known_sides(row.pattern, row.form, classes)
    if template is None:
        return CheckedTemplate(problems or unread)
    said = gloss(template.form, predicates_of(world), classes)
    return CheckedTemplate(problems, template, gloss=said)


@dataclass(frozen=True, slots=True)
class GroundedSample:
    """A command as somebody would say it, and the English sentence of its form."""

    text: str
    gloss: str


@dataclass(frozen=True, slots=True)
class GroundedSamples:
    """Some samples, the seed that gives others, and what the ontology lacks for more of them."""

    rows: tuple[GroundedSample, ...]
    next_seed: int
    missing: str = ""


def samples_of(world: World, checked: CheckedTemplate, seed: int = 0) -> GroundedSamples:
    """Draw commands of a template with entities in the place of its wildcards.

    The same template, ontology and ``seed`` give the same samples.
    """
    random, missing = Random(seed), ""
    ontology, declared = ontology_of(world), predicates_of(world)
    rows: dict[str, GroundedSample] = {}
    derivations = _derivations(checked)
    for derivation in random.choices(derivations, k=3 * SHOWN_SAMPLES) if derivations else ():
        try:
            grounded = ground(derivation.symbols, derivation.form, ontology, random)
        except LanguageError as error:
            missing = error.message
            continue
        said = gloss(grounded.form, declared, ontology.classes, ontology.class_of_text)
        rows.setdefault(grounded.text, GroundedSample(grounded.text, said))
    shown = tuple(islice(rows.values(), SHOWN_SAMPLES))
    return GroundedSamples(shown, (seed + 1) % LARGEST_SEED, missing)


def _derivations(checked: CheckedTemplate) -> list[Derivation]:
    """Return the first derivations of the template, as many as the budget of a check allows."""
    if checked.template is None or checked.checker is None or checked.has_errors:
        return []
    stream = checked.checker.expander.derivations(checked.template, budget=Budget(CHECK_STEPS))
    derivations: list[Derivation] = []
    with suppress(LanguageError):  # when the budget is spent, those before it will do
        derivations.extend(islice(stream, MOST_DERIVATIONS))
    return derivations
