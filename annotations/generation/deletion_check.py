"""What deleting a row would do to the rest of its world, before it is deleted. Writes nothing."""

from __future__ import annotations

from dataclasses import dataclass, field

from annotations.generation.category_uses import why_category_is_kept
from annotations.generation.class_uses import why_kept
from annotations.generation.predicate_check import BrokenTemplates, templates_without
from annotations.generation.production_check import ProductionEdit, problems_without
from annotations.generation.recipe_check import why_primitive_is_kept
from annotations.generation.world_consequences import (
    TemplateChange,
    WorldConsequences,
    consequences,
    consequences_of_lines,
)
from annotations.language.texts import Problem
from annotations.language.world import ontology_problems
from annotations.models import (
    Editable,
    Entity,
    EntityClass,
    Predicate,
    Primitive,
    Production,
    SemanticTemplate,
    TaskCategory,
)
from annotations.rows.from_rows import lines_of, ontology_of
from annotations.rows.occurrences import EntityOccurrences, occurrences_of


@dataclass(frozen=True)
class DeletionCheck:
    """``expected`` is what becomes of commands and splits, ``problems`` what the checker says then and not now.

    ``templates`` are those with a new problem; ``occurrences`` are where an entity is named. ``refusal`` says why it
    cannot be deleted, if it cannot.
    """

    expected: WorldConsequences = field(default_factory=WorldConsequences)
    problems: tuple[Problem, ...] = ()
    templates: BrokenTemplates = ()
    occurrences: EntityOccurrences | None = None
    refusal: str = ""


def check_deletion(row: Editable) -> DeletionCheck:
    """Return what deleting ``row`` would do. Commands depend on templates and the grammar alone."""
    match row:
        case SemanticTemplate():
            return DeletionCheck(consequences(row.owning_world, TemplateChange(row, None)))
        case Production():
            edit = ProductionEdit.of_stored(row)
            expected = consequences_of_lines(edit.world, edit.delete(lines_of(edit.world)))
            return DeletionCheck(expected, problems_without(edit))
        case EntityClass():
            return DeletionCheck(refusal=why_kept(row))
        case TaskCategory():
            return DeletionCheck(refusal=why_category_is_kept(row))
        case Primitive():
            return DeletionCheck(refusal=why_primitive_is_kept(row))
        case Predicate():
            return DeletionCheck(templates=templates_without(row.world, row.name))
        case Entity():
            world = row.owning_world
            known = {problem.message for problem in ontology_problems(ontology_of(world))}
            others = Entity.objects.filter(ontology=row.ontology_id).exclude(pk=row.pk)
            after = ontology_problems(ontology_of(world, others))
            new = (problem for problem in after if problem.message not in known)
            return DeletionCheck(problems=tuple(new), occurrences=occurrences_of(row))
    return DeletionCheck()
