"""What a protocol lets a parser know of its world, read from the world's rows (DESIGN §5)."""

from __future__ import annotations

from collections.abc import Callable

from annotations.language.anonymizer import Anonymizer
from annotations.models import World
from annotations.reading import ontology_of, predicates_of, task_categories
from parser_service.parsers.interface import Knowledge


def knowledge_of(world: World, protocol: str) -> Knowledge:
    """Nothing for *strict*; predicates and ontology for *domain*; the grammar too for *grammar*.

    Raises LanguageError where a stored text cannot be read. ``content_key.knowledge_hash`` covers
    the same rows.
    """
    if protocol == "strict":
        return Knowledge()
    predicates, ontology = predicates_of(world), ontology_of(world)
    if protocol == "domain":
        return Knowledge(predicates, ontology)
    return Knowledge(predicates, ontology, task_categories(world))


def anonymizer_of(world: World) -> Callable[[str], str]:
    """Writes a text with the world's entities as its generated commands are written."""
    anonymizer = Anonymizer(ontology_of(world))
    return lambda text: anonymizer.anonymize(text).command
