"""Verb: give a world its error categories."""

from __future__ import annotations

from annotations.models import World
from parser_service.analysis import categories
from parser_service.models import ErrorCategory


def ensure_categories(world: World) -> dict[str, ErrorCategory]:
    """Return the error categories of ``world`` by code, in their order.

    A world without any gets those of ``analysis.categories``. Categories that an admin has deleted do not
    come back while there are others.
    """
    rows = world.error_categories
    if not rows.exists():
        made = [
            ErrorCategory(
                world=world,
                code=code.value,
                name=categories.NAMES[code],
                description=categories.DESCRIPTIONS[code],
                position=position,
            )
            for position, code in enumerate(categories.ErrorCategory)
        ]
        # Whoever does the same at this moment makes the same rows.
        ErrorCategory.objects.bulk_create(made, ignore_conflicts=True)
    return {row.code: row for row in rows.select_related("slice")}
