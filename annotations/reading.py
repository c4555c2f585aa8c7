"""Turns rows back into the values of the language core. The one place for it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from annotations import models
from annotations.composition import split_entry
from annotations.language.errors import Position
from annotations.language.expansion import TaskCategory
from annotations.language.grammar import ROOT, Grammar, Production, read_production
from annotations.language.ontology import Entity, Ontology
from annotations.language.predicates import ArgumentKind, Predicate, PredicateKind, Signature
from annotations.language.renaming import renamed_production
from annotations.language.templates import SemanticTemplate, make_template
from annotations.models.templates import Status


@dataclass(frozen=True)
class AnnotatedCategory:
    """A task category as a value, and the rows of its templates in the same order."""

    value: TaskCategory
    template_rows: tuple[models.SemanticTemplate, ...]


def task_categories(world: models.World) -> tuple[TaskCategory, ...]:
    """The task categories in order, with the templates that are ready; none without a grammar.

    Raises:
        LanguageError: a stored text that cannot be read, with its file and line.
    """
    return tuple(category.value for category in annotated_categories(world))


def annotated_categories(world: models.World) -> tuple[AnnotatedCategory, ...]:
    """As ``task_categories``, beside the rows. Three queries; each text is read once."""
    categories = models.TaskCategory.objects.filter(grammar__world=world)
    productions = _productions(models.Production.objects.filter(grammar__world=world))
    rows = models.SemanticTemplate.objects.filter(grammar__world=world, status=Status.READY)
    values = {row: template_of(row) for row in rows}
    return tuple(_annotated(category, productions, values) for category in categories)


def grammar_of(category: models.TaskCategory) -> Grammar:
    """The grammar of one task category."""
    sources = [split_entry(entry)[0] for entry in category.rule_sources]
    rows = models.Production.objects.filter(grammar=category.grammar_id, source__in=sources)
    return _grammar(category, _productions(rows))


def production_of(row: models.Production) -> Production:
    """Raises LanguageError where the stored text is no expansion."""
    return read_production(
        f"${row.nonterminal} = {row.expansion}", Position(row.source, max(row.line, 1))
    )


def template_of(row: models.SemanticTemplate) -> SemanticTemplate:
    """Raises LanguageError where the stored pattern or form cannot be read."""
    return make_template(row.pattern, row.form, Position(row.source, max(row.line, 1)))


def ontology_of(world: models.World) -> Ontology:
    """The ontology in the order of its rows; an empty one where there is none."""
    rows = models.Entity.objects.filter(ontology__world=world)
    return Ontology(tuple(map(entity_of, rows)))


def entity_of(row: models.Entity) -> Entity:
    place = Position(row.source, max(row.line, 1))
    return Entity(row.entity_class, row.text, tuple(row.aliases), dict(row.attributes), place)


def predicates_of(
    world: models.World, rows: Iterable[models.Predicate] | None = None
) -> dict[str, Predicate]:
    """The predicates by name; ``rows`` limits them to some of the world's."""
    chosen = world.predicates.all() if rows is None else rows
    return {row.name: predicate_of(row) for row in chosen}


def predicate_of(row: models.Predicate) -> Predicate:
    signatures = (Signature(tuple(map(ArgumentKind, kinds))) for kinds in row.signatures)
    return Predicate(row.name, PredicateKind(row.kind), tuple(signatures), row.gloss)


def _productions(rows: Iterable[models.Production]) -> dict[str, list[Production]]:
    by_source: dict[str, list[Production]] = defaultdict(list)
    for row in rows:
        by_source[row.source].append(production_of(row))
    return by_source


def _grammar(category: models.TaskCategory, productions: Mapping[str, list[Production]]) -> Grammar:
    found: list[Production] = []
    for source, alias in map(split_entry, category.rule_sources):
        lines = productions.get(source, [])
        found += [renamed_production(each, ROOT, alias) for each in lines] if alias else lines
    return Grammar(tuple(found))


def _annotated(
    category: models.TaskCategory,
    productions: Mapping[str, list[Production]],
    templates: Mapping[models.SemanticTemplate, SemanticTemplate],
) -> AnnotatedCategory:
    chosen = tuple(_in_sets(category.template_sources, templates))
    values = tuple(templates[row] for row in chosen)
    return AnnotatedCategory(
        TaskCategory(category.name, _grammar(category, productions), values), chosen
    )


def _in_sets(
    sources: list[str], rows: Iterable[models.SemanticTemplate]
) -> Iterator[models.SemanticTemplate]:
    """The rows of the sources, source by source, each in its own order."""
    for source in sources:
        yield from (row for row in rows if row.source == source)
