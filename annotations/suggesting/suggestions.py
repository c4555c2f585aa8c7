"""Suggests a template to somebody who writes one: a pattern for a command, forms for a pattern."""

from __future__ import annotations

from dataclasses import dataclass, replace

from annotations.language.errors import LanguageError
from annotations.language.forms import to_template
from annotations.language.grammar import CHECK_STEPS, Budget, passages
from annotations.language.limits import MAX_PATTERN
from annotations.language.predicates import gloss
from annotations.language.suggesting import (
    FormSuggester,
    PatternMaker,
    nearest_patterns,
    transfer_form,
)
from annotations.language.symbols import print_sequence
from annotations.language.templates import TaskCategory, TemplateExpander, make_template
from annotations.models import SemanticTemplate as StoredTemplate
from annotations.models import TaskCategory as StoredCategory
from annotations.models import World
from annotations.rows.from_rows import grammar_of, predicates_of, task_categories, template_of

MOST_COMMAND = 500  # characters
MOST_COMPARED = 20_000  # derivations of the grammar


@dataclass(frozen=True, slots=True)
class ParserAnswer:
    """A form in corpus notation that a parser answers to a command; scores compare within one parser."""

    parser: str
    score: float
    form: str


@dataclass(frozen=True, slots=True)
class SuggestedForm:
    """A form in the notation of templates, its English sentence, and the pattern that it was made from.

    ``is_guess`` where no template says what one of the words means. ``answers`` are those of the parsers
    that give it; a form from a parser alone was made from no pattern.
    """

    text: str
    gloss: str
    made_from: str
    is_guess: bool = False
    answers: tuple[ParserAnswer, ...] = ()

    def answered_by(self, answer: ParserAnswer) -> SuggestedForm:
        """Return this form, marked as what a parser answers."""
        return replace(self, answers=(*self.answers, answer))


@dataclass(frozen=True, slots=True)
class SuggestedPattern:
    """A pattern, and one of its commands."""

    text: str
    command: str


def suggest_pattern(world: World, category: StoredCategory, command: str) -> str:
    """Return a pattern for an anonymized command without a form; the command where there is no better one."""
    plain = command[:MOST_COMMAND]
    try:
        categories = task_categories(world)
        templates = tuple(each for one in categories for each in one.templates)
        covered = frozenset(world.commands.values_list("anonymized_text", flat=True))
        maker = PatternMaker(_find_category(categories, category).grammar, templates, covered)
        pattern = maker.pattern(plain)
    except LanguageError:
        return plain
    return print_sequence(pattern) if pattern else plain


def suggest_nearest(world: World, row: StoredTemplate) -> list[SuggestedPattern]:
    """Return the patterns of the grammar of a template's category that are nearest to its own."""
    category = StoredCategory.objects.filter(grammar=row.grammar_id, name=row.task_category).first()
    if category is None:
        return []
    try:
        chosen = _find_category(task_categories(world), category)
        made = TemplateExpander(chosen.grammar).pairs(template_of(row), Budget(CHECK_STEPS))
        command, _ = next(made, ("", ""))
        derived = passages(chosen.grammar, Budget(CHECK_STEPS), MOST_COMPARED)
        nearest = nearest_patterns(command, derived, chosen.grammar, chosen.templates)
    except LanguageError:
        return []
    return [SuggestedPattern(print_sequence(pattern), example) for example, pattern in nearest]


def suggest_forms(
    world: World, category: StoredCategory | None, pattern: str
) -> list[SuggestedForm]:
    """Return forms for a pattern, the most likely first; none for a pattern that cannot be read."""
    if category is None or not pattern.strip() or len(pattern) > MAX_PATTERN:
        return []
    declared = predicates_of(world)
    try:
        symbols = make_template(pattern.strip(), "UNKNOWN").pattern
        suggester = FormSuggester(task_categories(world), declared or None)
        suggestions = suggester.suggest(symbols, grammar_of(category))
    except LanguageError:
        return []
    return [
        SuggestedForm(
            to_template(each.form),
            gloss(each.form, declared),
            each.template.pattern_text,
            each.is_guess,
        )
        for each in suggestions
    ]


def _find_category(categories: tuple[TaskCategory, ...], category: StoredCategory) -> TaskCategory:
    return next(each for each in categories if each.name == category.name)


def moved_form(category: StoredCategory, source: StoredTemplate, target: StoredTemplate) -> str:
    """Return the form of ``source`` with the slots of the pattern of ``target``; as it is where that fails."""
    try:
        old, new = template_of(source), template_of(target)
        form = transfer_form(old.form, old.pattern, new.pattern, grammar_of(category))
    except LanguageError:
        return source.form
    return to_template(form) if form is not None else source.form
