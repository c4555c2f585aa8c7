"""Turn rows back into values of the language core. Nothing else does."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from django.db.models import QuerySet

from annotations import models
from annotations.language.forms import EntityClasses
from annotations.language.grammar import Grammar, Production, apply_alias, read_production
from annotations.language.plans import (
    Primitive,
    Recipe,
    RecipeBook,
    default_book,
    read_primitive,
    read_recipe,
)
from annotations.language.templates import (
    BoundedCache,
    SemanticTemplate,
    TaskCategory,
    make_template,
)
from annotations.language.texts import Position
from annotations.language.world import Entity, Ontology, Predicate, PredicateKind, Signature
from annotations.models.description import TemplateStatus
from annotations.rows.composition import split_entry

# Texts read before, in this process: an editor asks for the same grammar with every key.
_GRAMMARS: BoundedCache[tuple[object, ...], Grammar] = BoundedCache(12)
_TEMPLATES: BoundedCache[tuple[str, str, Position], SemanticTemplate] = BoundedCache(20_000)

_PRIMITIVES: BoundedCache[str, Primitive] = BoundedCache(2_000)
_RECIPES: BoundedCache[str, Recipe] = BoundedCache(2_000)

# File → its productions in order: file, line, nonterminal, expansion.
Line = tuple[str, int, str, str]
Lines = Mapping[str, list[Line]]


@dataclass(frozen=True)
class AnnotatedCategory:
    """A task category as a value, and the rows of its templates in the same order."""

    value: TaskCategory
    template_rows: tuple[models.SemanticTemplate, ...]


def task_categories(world: models.World) -> tuple[TaskCategory, ...]:
    """Return the task categories in order, with the templates that are ready; none without a grammar.

    Raises:
        LanguageError: a stored text that cannot be read, with its file and line.
    """
    return tuple(category.value for category in annotated_categories(world))


def annotated_categories(
    world: models.World,
    rows: Iterable[models.SemanticTemplate] | None = None,
    lines: Lines | None = None,
) -> tuple[AnnotatedCategory, ...]:
    """Return what ``task_categories`` does, beside the rows. Three queries; each text is read once.

    ``rows`` are taken in place of the templates that are ready, in this order; each has a key.
    ``lines`` are taken in place of the productions of the world.
    """
    categories = models.TaskCategory.objects.filter(grammar__world=world)
    productions = lines_of(world) if lines is None else lines
    if rows is None:
        rows = ready_templates(world)
    values = {row: template_of(row) for row in rows}
    annotated = []
    for category in categories:
        # The rows of the sources, source by source, each in its own order.
        sources = category.template_sources
        chosen = tuple(row for source in sources for row in values if row.source == source)
        templates = tuple(values[row] for row in chosen)
        value = TaskCategory(category.name, _grammar(category, productions), templates)
        annotated.append(AnnotatedCategory(value, chosen))
    return tuple(annotated)


def ready_templates(world: models.World) -> QuerySet[models.SemanticTemplate]:
    """Return the templates of ``world`` that make commands, in order."""
    return models.SemanticTemplate.objects.filter(grammar__world=world, status=TemplateStatus.READY)


def lines_of(world: models.World) -> Lines:
    """Return the productions of the world, as they are stored."""
    return _by_source(models.Production.objects.filter(grammar__world=world))


def grammar_from(category: models.TaskCategory, lines: Lines) -> Grammar:
    """Return the grammar that the task category has with these ``lines``. Raises LanguageError for bad ones."""
    return _grammar(category, lines)


def grammar_of(category: models.TaskCategory) -> Grammar:
    """Return the grammar of one task category."""
    sources = [split_entry(entry)[0] for entry in category.rule_sources]
    rows = models.Production.objects.filter(grammar=category.grammar_id, source__in=sources)
    return _grammar(category, _by_source(rows))


def composition_of(category: models.TaskCategory) -> tuple[SemanticTemplate, ...]:
    """Return the templates of a task category that are lines for a nonterminal, in its order.

    Raises:
        LanguageError: one of them cannot be read.
    """
    rows = models.SemanticTemplate.objects.filter(grammar=category.grammar_id)
    by_source = _lines_in(rows.filter(status=TemplateStatus.READY))
    return tuple(line for source in category.template_sources for line in by_source.get(source, ()))


def composition_by_source(world: models.World) -> dict[str, list[SemanticTemplate]]:
    """Return file → the templates in it that are ready and lines for a nonterminal. Raises as ``composition_of``."""
    return _lines_in(ready_templates(world))


def _lines_in(rows: QuerySet[models.SemanticTemplate]) -> dict[str, list[SemanticTemplate]]:
    by_source: dict[str, list[SemanticTemplate]] = defaultdict(list)
    for row in rows.filter(pattern__startswith="$", pattern__contains="->"):
        line = template_of(row)
        if line.nonterminal:
            by_source[row.source].append(line)
    return by_source


def template_of(row: models.SemanticTemplate) -> SemanticTemplate:
    """Raises LanguageError where the stored pattern or form cannot be read."""
    place = Position(row.source, max(row.line, 1))
    return _TEMPLATES.get(
        (row.pattern, row.form, place), lambda: make_template(row.pattern, row.form, place)
    )


def ontology_of(world: models.World, rows: Iterable[models.Entity] | None = None) -> Ontology:
    """Return the ontology in the order of its rows, empty where there are none; ``rows`` limits it to some."""
    chosen = models.Entity.objects.filter(ontology__world=world) if rows is None else rows
    return Ontology(tuple(map(entity_of, chosen)), classes_of(world))


def classes_of(world: models.World) -> EntityClasses:
    """Return the classes of the world's entities."""
    return world.entity_classes.all().as_value()


def entity_of(row: models.Entity) -> Entity:
    place = Position(row.source, max(row.line, 1))
    return Entity(row.entity_class, row.text, tuple(row.aliases), dict(row.attributes), place)


def predicates_of(
    world: models.World, rows: Iterable[models.Predicate] | None = None
) -> dict[str, Predicate]:
    """Return the predicates by name; ``rows`` limits them to some of the world's."""
    chosen = world.predicates.all() if rows is None else rows
    return {row.name: predicate_of(row) for row in chosen}


def predicate_of(row: models.Predicate) -> Predicate:
    signatures = (Signature(tuple(kinds)) for kinds in row.signatures)
    return Predicate(row.name, PredicateKind(row.kind), tuple(signatures), row.gloss)


def recipe_book_of(world: models.World) -> RecipeBook:
    """Return the recipe book of ``world``; without recipes of its own what the shipped one has for its predicates.

    Raises:
        LanguageError: a stored row that cannot be read.
    """
    primitives = world.primitives.values_list("text", flat=True)
    recipes = world.recipes.values_list("text", flat=True)
    if recipes:
        return book_of(primitives, recipes)
    return default_book().of_actions(world.predicates.values_list("name", flat=True))


def book_of(primitives: Iterable[str], recipes: Iterable[str]) -> RecipeBook:
    """Return the book with these rows. Raises LanguageError for one that cannot be read."""
    return RecipeBook(tuple(map(primitive_of, primitives)), tuple(map(recipe_of, recipes)))


def primitive_of(text: str) -> Primitive:
    """Return the primitive of a row. Raises LanguageError."""
    return _PRIMITIVES.get(text, lambda: read_primitive(text))


def recipe_of(text: str) -> Recipe:
    """Return the recipe of a row. Raises LanguageError."""
    return _RECIPES.get(text, lambda: read_recipe(text))


def _by_source(rows: QuerySet[models.Production]) -> dict[str, list[Line]]:
    """Return file → its productions as they are stored: file, line, nonterminal, expansion."""
    by_source: dict[str, list[Line]] = defaultdict(list)
    for row in rows.values_list("source", "line", "nonterminal", "expansion"):
        by_source[row[0]].append(row)
    return by_source


def _grammar(category: models.TaskCategory, stored: Lines) -> Grammar:
    """Return the grammar of the category; the same value for the same texts, while it is kept."""
    parts = [
        (stored.get(source, []), alias) for source, alias in map(split_entry, category.rule_sources)
    ]
    key = tuple((tuple(lines), alias) for lines, alias in parts)
    return _GRAMMARS.get(key, lambda: _read_grammar(parts))


def _read_grammar(parts: Iterable[tuple[list[Line], str]]) -> Grammar:
    productions: list[Production] = []
    for lines, alias in parts:
        read = [
            read_production(f"${nonterminal} = {expansion}", Position(source, max(line, 1)))
            for source, line, nonterminal, expansion in lines
        ]
        productions += apply_alias(read, alias)
    return Grammar(tuple(productions))
