"""What a parser may know of its world under each protocol (docs/design/parsers.md, What a parser is)."""

from __future__ import annotations

from collections.abc import Callable

from annotations.language.grounding import Anonymizer
from annotations.models import World
from annotations.rows.from_rows import (
    ontology_of,
    predicates_of,
    recipe_book_of,
    task_categories,
)
from parser_service.analysis.plan_agreement import PlanAgreement
from parser_service.parsers.interface import Knowledge


def knowledge_of(world: World, protocol: str) -> Knowledge:
    """Read nothing for *strict*, predicates and ontology for *domain*, the grammar too for *grammar*.

    Raises LanguageError where a stored text cannot be read. ``content_key.knowledge_hash`` covers
    the same rows.
    """
    if protocol == "strict":
        return Knowledge()
    predicates, ontology = predicates_of(world), ontology_of(world)
    if protocol == "domain":
        return Knowledge(predicates, ontology)
    return Knowledge(predicates, ontology, task_categories(world))


def plan_agreement_of(world: World) -> PlanAgreement:
    """Return what compares the plans of answers, by what the world says now; it asks no database.

    Raises LanguageError where a stored text cannot be read.
    """
    return PlanAgreement(ontology_of(world), predicates_of(world), recipe_book_of(world))


def anonymizer_of(world: World) -> Callable[[str], str]:
    """Return a function that replaces the world's entities in a text by class tokens."""
    anonymizer = Anonymizer(ontology_of(world))
    return lambda text: anonymizer.anonymize(text).command
