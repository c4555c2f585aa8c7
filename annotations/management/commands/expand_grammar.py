"""``expand_grammar NAME --category C``: how many commands a grammar has."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.core.management.base import CommandError, CommandParser

from annotations.language.templates import DEFAULT_LIMIT
from annotations.management.base import Refused, ReportingCommand, find_world
from annotations.models import TaskCategory, World
from annotations.rows.from_rows import grammar_of


class Command(ReportingCommand):
    help = (
        "Counts the distinct anonymized commands of a task category's grammar. "
        "Above the limit it says how many there are at most, and enumerates none."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument("--category", required=True, help="the name of a task category")
        parser.add_argument("--limit", type=int, default=DEFAULT_LIMIT)

    def report(self, *, world: str, category: str, limit: int, **options: Any) -> Mapping[str, Any]:
        grammar = grammar_of(_find_category(find_world(world), category))
        size = grammar.size()
        if size > limit:
            sentence = (
                f"Category “{category}” has up to {size:,} commands, more than the limit of "
                f"{limit:,}. Raise it with --limit."
            )
            raise Refused({"size": size, "commands": None}, [sentence])
        return {"size": size, "commands": sum(1 for _ in grammar.commands(limit=limit))}


def _find_category(world: World, name: str) -> TaskCategory:
    categories = TaskCategory.objects.filter(grammar__world=world)
    category = categories.filter(name=name).first()
    if category is None:
        names = ", ".join(categories.values_list("name", flat=True)) or "none"
        raise CommandError(f"“{world}” has no task category “{name}”. It has: {names}.")
    return category
