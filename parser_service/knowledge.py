"""What a protocol lets a parser know of its world, read from the world's rows (DESIGN §5)."""

from __future__ import annotations

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
