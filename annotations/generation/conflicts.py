"""Pairs of templates that give the same command different forms."""

from __future__ import annotations

from dataclasses import dataclass

from annotations import models
from annotations.generation.kept_expansions import generate_at_once
from annotations.language.texts import LanguageError
from annotations.rows.from_rows import annotated_categories


@dataclass(frozen=True, slots=True)
class ConflictingPair:
    """Two templates and some of the commands that both make; the form of ``kept`` wins, as the later one.

    ``count`` is the number of those commands, ``task_category`` the one in which they meet.
    """

    task_category: str
    kept: models.SemanticTemplate
    lost: models.SemanticTemplate
    command: str
    count: int


@dataclass(frozen=True, slots=True)
class ConflictReport:
    """The pairs that disagree; ``trouble`` is a sentence about why they could not be worked out."""

    pairs: tuple[ConflictingPair, ...] = ()
    trouble: str = ""


def conflicts_of(world: models.World) -> ConflictReport:
    """Compare the templates of each task category with one another."""
    try:
        categories = annotated_categories(world)
        generated = generate_at_once([category.value for category in categories])
    except LanguageError as error:
        return ConflictReport(trouble=str(error))
    rows = {category.value.name: category.template_rows for category in categories}
    commands: dict[tuple[str, int, int], list[str]] = {}
    for conflict in generated.conflicts:
        *losing, (winner, _) = conflict.candidates
        for loser, _ in losing:
            key = (conflict.task_category, winner, loser)
            commands.setdefault(key, []).append(conflict.command)
    pairs = (
        ConflictingPair(name, rows[name][winner], rows[name][loser], shared[0], len(shared))
        for (name, winner, loser), shared in commands.items()
    )
    return ConflictReport(tuple(pairs))
