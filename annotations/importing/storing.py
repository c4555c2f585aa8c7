"""Writes what an import read into the rows of a world, changing only what differs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from annotations import models
from annotations.composition import owners, rule_sources, template_sources
from annotations.importing.generator_files import Generator
from annotations.language.grammar_files import GrammarFolder
from annotations.language.predicates import Predicate
from annotations.language.printing import print_sequence
from annotations.models.templates import Status
from annotations.problems import store_problems
from annotations.rows import Changes, synchronise


def store(world: models.World, generator: Generator) -> Changes:
    """Makes the world's ontology, grammar, templates and predicates those of ``generator``.

    A template that a person has changed keeps what it says; one that a person wrote stays, behind
    those of the files. To be called inside a transaction.
    """
    grammar, _ = models.Grammar.objects.get_or_create(world=world)
    ontology, _ = models.Ontology.objects.get_or_create(world=world)
    of_file = owners(generator.texts.compositions)
    changes = _store_categories(grammar, generator)
    changes += _store_productions(grammar, generator.texts.grammars, of_file)
    changes += _store_templates(grammar, generator, of_file)
    changes += _store_entities(ontology, generator)
    changes += store_predicates(world, generator.predicates.values())
    for subject, problems in generator.problems.items():
        store_problems(world, subject, problems)
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


def _store_productions(
    grammar: models.Grammar, folder: GrammarFolder, of_file: Mapping[str, str]
) -> Changes:
    lines = [line for file in folder.files.values() for line in file.productions]
    wanted = [
        models.Production(
            grammar=grammar,
            source=line.position.source,
            line=line.position.line,
            nonterminal=line.nonterminal,
            expansion=print_sequence(line.expansion),
            task_category=of_file.get(line.position.source, ""),
            position=position,
        )
        for position, line in enumerate(lines)
    ]
    return synchronise(
        grammar.productions.all(),
        wanted,
        lambda row: (row.source, row.nonterminal, row.expansion),
        ["line", "task_category", "position"],
    )


def _store_templates(
    grammar: models.Grammar, generator: Generator, of_file: Mapping[str, str]
) -> Changes:
    lines = [line for templates in generator.texts.templates.values() for line in templates]
    wanted = [
        models.SemanticTemplate(
            grammar=grammar,
            source=line.position.source,
            line=line.position.line,
            task_category=of_file.get(line.position.source, ""),
            pattern=line.pattern_text,
            form=line.form_text,
            imported_text=f"{line.pattern_text} = {line.form_text}",
            position=position,
        )
        for position, line in enumerate(lines)
    ]
    return synchronise(
        grammar.templates.all(),
        wanted,
        lambda row: (row.source, row.imported_text),
        ["line", "task_category", "position"],
        is_kept=lambda row: row.author_id is not None or row.status != Status.READY,
    )


def _store_entities(ontology: models.Ontology, generator: Generator) -> Changes:
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
    return synchronise(
        ontology.entities.all(),
        wanted,
        lambda row: (row.entity_class, row.text, row.attributes.get("room", "")),
        ["aliases", "attributes", "source", "line", "position"],
    )


def store_predicates(world: models.World, predicates: Iterable[Predicate]) -> Changes:
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
    )
