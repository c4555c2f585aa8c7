"""The forms that the annotated grammar derives for a command: in the web process, by its chart."""

from __future__ import annotations

from functools import lru_cache

from annotations.language.errors import LanguageError
from annotations.models import World
from annotations.rows.from_rows import task_categories
from parser_service.parsers.interface import Candidate, Knowledge
from parser_service.parsers.oracle import GrammarOracle

KEPT_WORLDS = 4


def derived_forms(world: World, anonymized_text: str, how_many: int) -> list[Candidate]:
    """Return the forms of all derivations, first the one that generation keeps; none outside the grammar."""
    oracle = _oracle(world.pk, world.revision, world.generations)
    return oracle.predict([anonymized_text], how_many)[0] if oracle else []


@lru_cache(maxsize=KEPT_WORLDS)
def _oracle(world_id: int, revision: int, generations: int) -> GrammarOracle | None:
    """Return the chart of the grammar as it is at this revision; None where it cannot be read."""
    try:
        categories = task_categories(World.objects.get(pk=world_id))
        return GrammarOracle(knowledge=Knowledge(grammar=categories)) if categories else None
    except LanguageError:
        return None
