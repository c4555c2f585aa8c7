"""Suggest a pattern for a command and forms for a pattern, and find templates that say the same."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from random import Random

from annotations.generation.kept_expansions import checker_of, expansions_of, problems_of
from annotations.language.forms import canonicalize, print_sequence, read_form, to_template
from annotations.language.grammar import CHECK_STEPS, Budget, passages
from annotations.language.grounding import ground
from annotations.language.templates import (
    MOST_SUGGESTIONS,
    Derivation,
    FormSuggester,
    PatternMaker,
    TaskCategory,
    TemplateChecker,
    TemplateExpander,
    lift_forms,
    make_template,
    nearest_patterns,
    read_sides,
    transfer_form,
)
from annotations.language.texts import MAX_PATTERN, LanguageError, Position
from annotations.language.world import Predicate, gloss
from annotations.models import SemanticTemplate as StoredTemplate
from annotations.models import TaskCategory as StoredCategory
from annotations.models import World
from annotations.models.description import TemplateStatus
from annotations.rows.from_rows import (
    classes_of,
    composition_of,
    grammar_of,
    ontology_of,
    predicates_of,
    ready_templates,
    task_categories,
    template_of,
)

MOST_COMMAND = 500  # characters
MOST_COMPARED = 20_000  # derivations of the grammar
MOST_LOOKED_AT = 2_000  # commands of a pattern
MOST_DERIVED = 100  # of them, among which the command is looked for whose entities are said


@dataclass(frozen=True, slots=True)
class ParserAnswer:
    """A form in corpus notation that a parser answers to a command; scores compare within one parser."""

    parser: str
    score: float
    form: str


@dataclass(frozen=True, slots=True)
class SuggestedForm:
    """A form in the notation of templates, its English sentence, and the pattern that it was made from.

    ``is_sure`` where a page may fill it in (docs/design/suggestions.md, Filled in or offered). ``answers`` are
    those of the parsers that give it; a form from a parser alone was made from no pattern.
    """

    text: str
    gloss: str
    made_from: str
    is_sure: bool = False
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
        made = TemplateExpander(chosen.grammar, chosen.lines).pairs(
            template_of(row), Budget(CHECK_STEPS)
        )
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
    declared, classes = predicates_of(world), classes_of(world)
    try:
        symbols = make_template(pattern.strip(), "UNKNOWN").pattern
        suggester = FormSuggester(task_categories(world), declared or None)
        suggestions = suggester.suggest(symbols, grammar_of(category))
    except LanguageError:
        return []
    return [
        SuggestedForm(
            to_template(suggestion.form),
            gloss(suggestion.form, declared, classes),
            suggestion.template.pattern_text,
            suggestion.is_sure,
        )
        for suggestion in suggestions
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


def say_with_entities(
    world: World,
    category: StoredCategory,
    pattern: str,
    wanted: str,
    suggestions: Sequence[SuggestedForm],
) -> tuple[str, list[SuggestedForm]]:
    """Return a command of the pattern with entities in it, and the suggestions said with the same entities.

    The command is that of ``wanted`` if it is among the first of the pattern, else the first. It is empty, and the
    suggestions stay as they are, where none can be drawn.
    """
    ontology, declared = ontology_of(world), predicates_of(world)
    said, example = [], ""
    try:
        expander = TemplateExpander(grammar_of(category), composition_of(category))
        for each in suggestions:
            derivation = _derivation_for(expander, pattern, each.text, wanted)
            grounded = ground(derivation.symbols, derivation.form, ontology, Random(0))
            sentence = gloss(grounded.form, declared, ontology.classes, ontology.class_of_text)
            said.append(replace(each, gloss=sentence))
            example = grounded.text
    except LanguageError:
        return "", list(suggestions)
    return example, said


def _derivation_for(expander: TemplateExpander, pattern: str, form: str, wanted: str) -> Derivation:
    """Return the derivation of ``wanted`` if it is among the first ``MOST_DERIVED``, else the first. Raises
    LanguageError where there is none."""
    stream = expander.derivations(make_template(pattern.strip(), form), budget=Budget(CHECK_STEPS))
    derivations = list(islice(stream, MOST_DERIVED if wanted else 1))
    if not derivations:
        raise LanguageError("the pattern makes no command", Position("pattern"))
    same = (each for each in derivations if each.anonymized_text == wanted)
    return next(same, derivations[0])


def command_for(category: StoredCategory, pattern: str, wanted: str = "") -> str:
    """Return ``wanted`` if it is a command of the pattern, else its first; empty where it makes none.

    Parsers are asked for no command of more than ``MOST_COMMAND`` characters.
    """
    try:
        template = make_template(pattern, "UNKNOWN")
        expander = TemplateExpander(grammar_of(category), composition_of(category))
        pairs = expander.pairs(template, Budget(CHECK_STEPS))
        looked_at = dict(islice(pairs, MOST_LOOKED_AT))
    except LanguageError:
        return ""
    commands = [command for command in looked_at if len(command) <= MOST_COMMAND]
    return wanted if wanted in commands else next(iter(commands), "")


def commands_of(row: StoredTemplate) -> frozenset[str]:
    """Return the first commands that a template makes, at most ``MOST_LOOKED_AT``; none where it has an error."""
    category = StoredCategory.objects.filter(grammar=row.grammar_id, name=row.task_category).first()
    if category is None:
        return frozenset()
    try:
        expander = TemplateExpander(grammar_of(category), composition_of(category))
        pairs = expander.pairs(template_of(row), Budget(CHECK_STEPS))
        return frozenset(command for command, _ in islice(pairs, MOST_LOOKED_AT))
    except LanguageError:
        return frozenset()


def add_answers(
    world: World,
    category: StoredCategory,
    pattern: str,
    suggestions: Sequence[SuggestedForm],
    answers: Sequence[Sequence[ParserAnswer]],
) -> list[SuggestedForm]:
    """Return the suggestions with the first well-typed answer of each parser, marked as its own.

    What is new stands last, so that the others keep their digits while an answer comes.

    Args:
        answers: of each parser, ranked. Their forms are of one command of ``pattern``, with class tokens.
    """
    try:
        lifting = _Lifting(world, category, pattern)
    except LanguageError:
        return list(suggestions)
    by_text = {each.text: each for each in suggestions}
    added: list[str] = []
    for ranked in answers:
        text, answer = next(lifting.well_typed(ranked, by_text), ("", None))
        if answer is None:
            continue
        if text not in by_text:
            by_text[text] = SuggestedForm(text, lifting.gloss(text), "")
            added.append(text)
        by_text[text] = by_text[text].answered_by(answer)
    kept = [each.text for each in suggestions][: MOST_SUGGESTIONS - len(added)]
    return [by_text[text] for text in (*kept, *added)]


class _Lifting:
    """Reads answers as forms of one pattern. Raises LanguageError where the pattern cannot be read."""

    def __init__(self, world: World, category: StoredCategory, pattern: str) -> None:
        self.pattern = pattern
        self.symbols = make_template(pattern, "UNKNOWN").pattern
        self.predicates: Mapping[str, Predicate] = predicates_of(world)
        self.classes = classes_of(world)
        self.checker: TemplateChecker = checker_of(
            grammar_of(category), self.predicates, category.name, composition_of(category)
        )

    def well_typed(
        self, answers: Sequence[ParserAnswer], known: Mapping[str, SuggestedForm]
    ) -> Iterator[tuple[str, ParserAnswer]]:
        """Yield answers as forms of the pattern of which the checker says nothing; known ones are such."""
        for answer in answers:
            try:
                form = read_form(answer.form)
            except LanguageError:
                continue
            lifted = lift_forms(form, self.symbols, self.checker.grammar)
            texts = [to_template(canonicalize(each)) for each in lifted]
            typed = (text for text in texts if self._is_well_typed(text))
            text = next((text for text in texts if text in known), None) or next(typed, None)
            if text is not None:
                yield text, answer

    def gloss(self, text: str) -> str:
        """Return the English sentence of a form in the notation of templates."""
        return gloss(make_template(self.pattern, text).form, self.predicates, self.classes)

    def _is_well_typed(self, text: str) -> bool:
        template, _ = read_sides(self.pattern, text)
        problems = problems_of(self.checker, template) if template else ()
        return template is not None and not any(
            problem.is_error or problem.position.source == "form" for problem in problems
        )


@dataclass(frozen=True, slots=True)
class DuplicateTemplate:
    """``other`` says the same as a template; ``moves`` are the task categories where that would be alone."""

    other: StoredTemplate
    moves: tuple[StoredCategory, ...]


def duplicate_of(world: World, row: StoredTemplate) -> DuplicateTemplate | None:
    """Return the first template that is ready, says the same as ``row`` and shares a task category with it."""
    if row.status != TemplateStatus.READY:
        return None
    try:  # the same form, and a pattern that reads the same
        pattern = template_of(row).pattern
        others = ready_templates(world).filter(form=row.form).exclude(pk=row.pk)
        same = [each for each in others if template_of(each).pattern == pattern]
    except LanguageError:
        return None
    categories = StoredCategory.objects.filter(grammar=row.grammar_id)
    together = [each for each in categories if row.source in each.template_sources]
    for other in same:
        if any(other.source in category.template_sources for category in together):
            taken = {row.source, *(each.source for each in same)}
            moves = (each for each in categories if row.moved_to(each) and _takes(each, row, taken))
            return DuplicateTemplate(other, tuple(moves))
    return None


def _takes(category: StoredCategory, row: StoredTemplate, taken: set[str]) -> bool:
    """Return whether the template would be alone there, and make commands of the grammar."""
    if taken & set(category.template_sources):
        return False
    try:
        command = command_for(category, row.pattern)
        return bool(command) and expansions_of(grammar_of(category)).accepts(command)
    except LanguageError:
        return False
