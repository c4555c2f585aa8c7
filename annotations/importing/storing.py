"""Writes what an import read into the rows of a world, changing only what differs."""

from __future__ import annotations

from typing import Any, Self

from annotations import models
from annotations.importing.generator_files import Generator
from annotations.importing.plans import (
    plan_entities,
    plan_predicates,
    plan_productions,
    plan_templates,
)
from annotations.models.description import Subject
from annotations.rows.composition import rule_sources, template_sources
from annotations.rows.problems import store_problems
from annotations.rows.staging import Staging
from annotations.rows.synchronise import Changes, Plan, synchronise
from annotations.rows.template_problems import store_problems_of_import


class PreparedProductions:
    """The productions of ``generator``, collected before the transaction, so that writing many is quick.

    ``planned`` is what it takes to store them in ``world`` as it was read.
    """

    COLUMNS = ("source", "line", "nonterminal", "expansion", "task_category", "position", "version")

    def __init__(
        self,
        world: models.World | None,
        generator: Generator,
        planned: Plan[models.Production],
        brings_back: bool,
    ) -> None:
        self._generator = generator
        self._brings_back = brings_back
        self._revision = world.revision if world else 0
        self._plan = planned
        self._staging = Staging(models.Production, self.COLUMNS)

    def __enter__(self) -> Self:
        self._staging.__enter__().add_new(self._plan.new)
        return self

    def __exit__(self, *raised: Any) -> None:
        self._staging.__exit__(*raised)

    def apply(
        self, world: models.World, grammar: models.Grammar, by: models.User | None
    ) -> Changes:
        """Write them, inside a transaction; compare again if somebody has changed the world since."""
        if world.revision != self._revision:
            return plan_productions(grammar, self._generator, self._brings_back).apply(by)
        self._plan.apply_to_stored(by)
        self._staging.insert(grammar_id=str(int(grammar.pk)))
        return self._plan.changes


def store(
    world: models.World,
    generator: Generator,
    productions: PreparedProductions,
    by: models.User | None = None,
    brings_back: bool = False,
) -> Changes:
    """Make the world's ontology, grammar, templates and predicates those of ``generator``.

    What a person has changed keeps what it says; a template that a person wrote stays, behind those of
    the files. What a person has deleted stays away unless ``brings_back``. To be called inside a
    transaction, where all but the productions is compared once more: edits of entities, predicates and
    drafts do not change the world's revision.
    """
    grammar, _ = models.Grammar.objects.select_related("world").get_or_create(world=world)
    ontology, _ = models.Ontology.objects.select_related("world").get_or_create(world=world)
    changes = _store_categories(grammar, generator)
    changes += productions.apply(world, grammar, by)
    changes += plan_templates(grammar, generator, brings_back).apply(by)
    if not changes.is_none or changes.moved:
        world.mark_changed()
    changes += plan_entities(ontology, generator, brings_back).apply(by)
    changes += plan_predicates(world, generator, brings_back).apply(by)
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
