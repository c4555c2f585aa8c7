"""Writes what an import read into the rows of a world, changing only what differs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from types import TracebackType
from typing import Self

from annotations import models
from annotations.editing.template_problems import store_problems_of_import
from annotations.importing.generator_files import Generator
from annotations.language.predicates import Predicate
from annotations.language.symbols import print_sequence
from annotations.models.problems import Subject
from annotations.models.templates import Status
from annotations.rows.composition import owners, rule_sources, template_sources
from annotations.rows.history import keys_changed_by_people
from annotations.rows.problems import store_problems
from annotations.rows.staging import Staging
from annotations.rows.synchronise import Changes, Plan, plan, synchronise


@dataclass(frozen=True)
class Removals:
    """What an import would take away, by what it is: the texts of the rows."""

    templates: tuple[str, ...] = ()
    productions: tuple[str, ...] = ()
    entities: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.templates or self.productions or self.entities)

    def as_json(self) -> dict[str, list[str]]:
        return {name: list(texts) for name, texts in asdict(self).items()}


def removals_of(world: models.World | None, generator: Generator) -> Removals:
    """What of ``world`` the files of ``generator`` do not have any more. Nothing is written."""
    if world is None:
        return Removals()
    owner_by_file = owners(generator.texts.compositions)
    grammar = models.Grammar.objects.filter(world=world).first()
    ontology = models.Ontology.objects.filter(world=world).first()
    return Removals(
        templates=_texts(_plan_templates(grammar, generator, owner_by_file)) if grammar else (),
        productions=_texts(_plan_productions(grammar, generator)) if grammar else (),
        entities=_texts(_plan_entities(ontology, generator)) if ontology else (),
    )


def _texts(changes: Plan) -> tuple[str, ...]:
    """Each removed row with its file, in the order of the rows."""
    rows = sorted(changes.removed, key=lambda row: row.position)
    return tuple(f"{row.source}: {row}" for row in rows)


class PreparedProductions:
    """The productions of ``generator``, compared and collected, so that writing many is quick."""

    COLUMNS = ("source", "line", "nonterminal", "expansion", "task_category", "position", "version")

    def __init__(self, world: models.World | None, generator: Generator) -> None:
        grammar = models.Grammar.objects.filter(world=world).first() if world else None
        self._generator = generator
        self._revision = world.revision if world else 0
        self._plan = _plan_productions(grammar or models.Grammar(), generator)
        self._staging = Staging(models.Production, self.COLUMNS)

    def __enter__(self) -> Self:
        self._staging.__enter__().add_new(self._plan.new)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._staging.__exit__(kind, error, traceback)

    def apply(
        self, world: models.World, grammar: models.Grammar, by: models.User | None
    ) -> Changes:
        """Writes them; inside a transaction. Compares anew where somebody has changed the world since."""
        if world.revision != self._revision:
            return _plan_productions(grammar, self._generator).apply(by)
        self._plan.apply_to_stored(by)
        self._staging.insert(grammar_id=str(int(grammar.pk)))
        return self._plan.changes


def store(
    world: models.World,
    generator: Generator,
    productions: PreparedProductions,
    by: models.User | None = None,
) -> Changes:
    """Makes the world's ontology, grammar, templates and predicates those of ``generator``.

    A template or an entity that a person has changed keeps what it says; a template that a person wrote
    stays, behind those of the files. To be called inside a transaction.
    """
    grammar, _ = models.Grammar.objects.get_or_create(world=world)
    ontology, _ = models.Ontology.objects.get_or_create(world=world)
    owner_by_file = owners(generator.texts.compositions)
    changes = _store_categories(grammar, generator)
    changes += productions.apply(world, grammar, by)
    changes += _plan_templates(grammar, generator, owner_by_file).apply(by)
    if not changes.is_none or changes.moved:
        world.mark_changed()
    changes += _plan_entities(ontology, generator).apply(by)
    changes += store_predicates(world, generator.predicates.values(), by)
    for subject, problems in generator.problems.items():
        store_problems(world, subject, problems)
    store_problems_of_import(grammar, generator.problems[Subject.TEMPLATES])
    return changes


def _store_categories(grammar: models.Grammar, generator: Generator) -> Changes:
    wanted = [
        models.TaskCategory(
            grammar=grammar,
            name=category.name,
            position=position,
            rule_sources=rule_sources(generator.texts.grammars, category.grammar_file),
            template_sources=template_sources(category),
        )
        for position, category in enumerate(generator.texts.compositions)
    ]
    fields = ["position", "rule_sources", "template_sources"]
    return synchronise(grammar.task_categories.all(), wanted, lambda row: row.name, fields)


def _plan_productions(grammar: models.Grammar, generator: Generator) -> Plan[models.Production]:
    owner_by_file = owners(generator.texts.compositions)
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
    return plan(
        models.Production.objects.filter(grammar=grammar.pk),
        wanted,
        lambda row: (row.source, row.nonterminal, row.expansion),
        ["line", "task_category", "position"],
    )


def _plan_templates(
    grammar: models.Grammar, generator: Generator, owner_by_file: Mapping[str, str]
) -> Plan[models.SemanticTemplate]:
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
    return plan(
        grammar.templates.all(),
        wanted,
        lambda row: (row.source, row.imported_text),
        ["line", "task_category", "position"],
        is_kept=_is_of_people,
    )


def _is_of_people(template: models.SemanticTemplate) -> bool:
    """Whether somebody wrote, changed or put aside the template since its file was imported."""
    is_as_imported = template.imported_text == f"{template.pattern} = {template.form}"
    return template.author_id is not None or template.status != Status.READY or not is_as_imported


def _plan_entities(ontology: models.Ontology, generator: Generator) -> Plan[models.Entity]:
    wanted = [
        models.Entity(
            ontology=ontology,
            entity_class=entity.entity_class,
            text=entity.text,
            aliases=list(entity.aliases),
            attributes=dict(entity.attributes),
            source=entity.position.source,
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
    return plan(
        ontology.entities.all(),
        wanted,
        _key_of_entity,
        ["aliases", "attributes", "source", "line", "position"],
    )


def _key_of_entity(row: models.Entity) -> tuple[str, str, str]:
    return row.entity_class, row.text, row.attributes.get("room", "")


def store_predicates(
    world: models.World, predicates: Iterable[Predicate], by: models.User | None = None
) -> Changes:
    """Adds and updates predicates; those that a person has changed stay as they are."""
    edited = set(world.predicates.filter(is_edited=True).values_list("name", flat=True))
    wanted = [
        models.Predicate(
            world=world,
            name=predicate.name,
            kind=predicate.kind,
            signatures=[list(signature.arguments) for signature in predicate.signatures],
            gloss=predicate.gloss,
        )
        for predicate in predicates
        if predicate.name not in edited
    ]
    return synchronise(
        world.predicates.filter(is_edited=False),
        wanted,
        lambda row: row.name,
        ["kind", "signatures", "gloss"],
        by=by,
    )
