"""Compare what an import read with the rows of a world, and say what it takes to make them equal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, TypeAlias

from annotations import models
from annotations.exchange.generator_files import Generator
from annotations.language.forms import print_sequence
from annotations.models.description import TemplateStatus
from annotations.rows.composition import owners, rule_sources, split_entry, template_sources
from annotations.rows.decisions import respect
from annotations.rows.history import keys_changed_by_people
from annotations.rows.synchronise import RowPlan, plan

Categories: TypeAlias = Sequence[models.TaskCategory]  # those that people added, changed or renamed


@dataclass(frozen=True)
class RowTexts:
    """Texts of rows, by what they are."""

    templates: tuple[str, ...] = ()
    productions: tuple[str, ...] = ()
    entities: tuple[str, ...] = ()
    predicates: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return any(asdict(self).values())

    def as_json(self) -> dict[str, list[str]]:
        return {name: list(texts) for name, texts in asdict(self).items()}


@dataclass(frozen=True)
class Differences:
    """What the files and a world have apart.

    ``removals`` are rows that the files lack. ``left_out`` are lines that are not stored because people
    have deleted, moved or renamed the row: each with its file, and who did what. ``productions`` says what
    it takes to store them; ``has_own_categories`` whether people have added or changed task categories.
    """

    productions: RowPlan[models.Production]
    has_own_categories: bool = False
    removals: RowTexts = field(default_factory=RowTexts)
    left_out: RowTexts = field(default_factory=RowTexts)


def differences_of(
    world: models.World | None, generator: Generator, brings_back: bool
) -> Differences:
    """Compare the files of ``generator`` with ``world``. Nothing is written."""
    if world is None:
        return Differences(plan_productions(models.Grammar(), generator, brings_back))
    grammar = models.Grammar.objects.select_related("world").filter(world=world).first()
    ontology = models.Ontology.objects.select_related("world").filter(world=world).first()
    of_people = categories_of_people(grammar) if grammar else ()
    productions = plan_productions(grammar or models.Grammar(), generator, brings_back, of_people)
    plans: dict[str, RowPlan[Any]] = {"productions": productions}
    if grammar:
        plans["templates"] = plan_templates(grammar, generator, brings_back, of_people)
    if ontology:
        plans["entities"] = plan_entities(ontology, generator, brings_back)
    removals = {
        name: tuple(
            f"{row.source}: {row}" for row in sorted(planned.removed, key=lambda row: row.position)
        )
        for name, planned in plans.items()
    }
    plans["predicates"] = plan_predicates(world, generator, brings_back)
    left_out = {
        name: tuple(
            f"{row.source}: {row} ({why})" if hasattr(row, "source") else f"{row} ({why})"
            for row, why in planned.left_out
        )
        for name, planned in plans.items()
    }
    return Differences(productions, bool(of_people), RowTexts(**removals), RowTexts(**left_out))


def plan_categories(
    grammar: models.Grammar, generator: Generator, of_people: Categories
) -> RowPlan[models.TaskCategory]:
    """Plan the task categories; those ``of_people`` stay as they are."""
    kept = {own: row for row in of_people for own in _own_files(row)}
    wanted = []
    for position, category in enumerate(generator.texts.compositions):
        row = models.TaskCategory(
            grammar=grammar,
            name=category.name,
            position=position,
            rule_sources=rule_sources(generator.texts.grammars, category.grammar_file),
            template_sources=template_sources(category),
        )
        if stored := kept.get(category.grammar_file):
            row.name, row.rule_sources = stored.name, stored.rule_sources
            row.template_sources = stored.template_sources
        wanted.append(row)
    fields = ["position", "rule_sources", "template_sources"]
    stored_rows = grammar.task_categories.all()
    return plan(stored_rows, wanted, lambda row: row.name, fields, of_people.__contains__)


def categories_of_people(grammar: models.Grammar) -> list[models.TaskCategory]:
    """Return the task categories that people added, changed or renamed."""
    keys = keys_changed_by_people(models.TaskCategory, grammar.world)
    return list(grammar.task_categories.filter(pk__in=keys)) if keys else []


def _own_files(row: models.TaskCategory) -> tuple[str, str]:
    return split_entry(row.rule_sources[-1])[0], row.template_sources[-1]


def _owners(generator: Generator, of_people: Categories) -> dict[str, str]:
    """Return file → the task category that it was written for, by the names that people gave these."""
    names = {own: row.name for row in of_people for own in _own_files(row)}
    return owners(generator.texts.compositions) | names


def plan_productions(
    grammar: models.Grammar, generator: Generator, brings_back: bool, of_people: Categories = ()
) -> RowPlan[models.Production]:
    """Plan the productions of ``grammar``, in the order of the files and their lines."""
    owner_by_file = _owners(generator, of_people)
    files = generator.texts.grammars.files.values()
    lines = [line for file in files for line in file.productions]
    wanted = [
        models.Production(
            grammar_id=grammar.pk,
            source=line.position.source,
            line=line.position.line,
            nonterminal=line.nonterminal,
            expansion=print_sequence(line.expansion),
            task_category=owner_by_file.get(line.position.source, ""),
            position=position,
        )
        for position, line in enumerate(lines)
    ]
    planned = plan(
        models.Production.objects.filter(grammar=grammar.pk),
        wanted,
        _key_of_production,
        ["line", "task_category", "position"],
    )
    if grammar.pk is None:
        return planned
    return respect(planned, grammar.world, _key_of_production, brings_back)


def _key_of_production(row: models.Production) -> tuple[str, str, str]:
    return row.source, row.nonterminal, row.expansion


def plan_templates(
    grammar: models.Grammar, generator: Generator, brings_back: bool, of_people: Categories
) -> RowPlan[models.SemanticTemplate]:
    """Plan the templates; those that people wrote or changed stay, whatever the files have."""
    owner_by_file = _owners(generator, of_people)
    lines = [line for templates in generator.texts.templates.values() for line in templates]
    wanted = [
        models.SemanticTemplate(
            grammar=grammar,
            source=line.position.source,
            line=line.position.line,
            task_category=owner_by_file.get(line.position.source, ""),
            pattern=line.pattern_text,
            form=line.form_text,
            imported_text=f"{line.pattern_text} = {line.form_text}",
            position=position,
        )
        for position, line in enumerate(lines)
    ]
    planned = plan(
        grammar.templates.all(),
        wanted,
        _key_of_template,
        ["line", "task_category", "position"],
        is_kept=_is_of_people,
    )
    return respect(planned, grammar.world, _key_of_template, brings_back)


def _key_of_template(row: models.SemanticTemplate) -> tuple[str, str]:
    return row.source, row.imported_text


def _is_of_people(template: models.SemanticTemplate) -> bool:
    """Return whether somebody wrote, changed or put aside the template since its file was imported."""
    is_as_imported = template.imported_text == f"{template.pattern} = {template.form}"
    return (
        template.author_id is not None
        or template.status != TemplateStatus.READY
        or not is_as_imported
    )


def plan_classes(world: models.World, generator: Generator) -> RowPlan[models.EntityClass]:
    """Plan the classes of entities; none is removed, and what people have changed stays as it is."""
    wanted = [
        models.EntityClass.of(world, value, position)
        for position, value in enumerate(generator.ontology.classes)
    ]
    keys = keys_changed_by_people(models.EntityClass, world)
    changed = {row.token: row for row in world.entity_classes.filter(pk__in=keys)}
    fields = ["singular", "plural", "said", "hue", "is_closed"]
    for row in wanted:
        if stored := changed.get(row.token):
            for name in fields:
                setattr(row, name, getattr(stored, name))
    return plan(world.entity_classes.all(), wanted, lambda row: row.token, [*fields, "position"])


def plan_entities(
    ontology: models.Ontology, generator: Generator, brings_back: bool
) -> RowPlan[models.Entity]:
    """Plan the entities; aliases and attributes that people have changed stay as they are."""
    wanted = [
        models.Entity(
            ontology=ontology,
            entity_class=entity.entity_class,
            text=entity.text,
            aliases=list(entity.aliases),
            attributes=dict(entity.attributes),
            source=entity.position.source.lower(),
            line=entity.position.line,
            position=position,
        )
        for position, entity in enumerate(generator.ontology.entities)
    ]
    keys = keys_changed_by_people(models.Entity, ontology.world)
    changed = {_key_of_entity(row): row for row in ontology.entities.filter(pk__in=keys)}
    for row in wanted:
        if stored := changed.get(_key_of_entity(row)):
            row.aliases, row.attributes = stored.aliases, stored.attributes
    planned = plan(
        ontology.entities.all(),
        wanted,
        _key_of_entity,
        ["aliases", "attributes", "source", "line", "position"],
    )
    return respect(planned, ontology.world, _key_of_entity, brings_back)


def _key_of_entity(row: models.Entity) -> tuple[str, str, str]:
    return row.entity_class, row.text, row.attributes.get("room", "")


def plan_predicates(
    world: models.World, generator: Generator, brings_back: bool
) -> RowPlan[models.Predicate]:
    """Plan the predicates; those that a person has changed stay as they are."""
    edited = set(world.predicates.filter(is_edited=True).values_list("name", flat=True))
    wanted = [
        models.Predicate(
            world=world,
            name=predicate.name,
            kind=predicate.kind,
            signatures=[list(signature.arguments) for signature in predicate.signatures],
            gloss=predicate.gloss,
        )
        for predicate in generator.predicates.values()
        if predicate.name not in edited
    ]
    stored = world.predicates.filter(is_edited=False)
    planned = plan(stored, wanted, _key_of_predicate, ["kind", "signatures", "gloss"])
    return respect(planned, world, _key_of_predicate, brings_back)


def _key_of_predicate(row: models.Predicate) -> str:
    return row.name
