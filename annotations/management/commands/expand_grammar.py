"""``expand_grammar NAME --category C``: how many commands a grammar has."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.core.management.base import CommandError, CommandParser

from annotations.language.templates import DEFAULT_LIMIT
from annotations.management.base import RefusedReport, ReportingCommand, find_world
from annotations.models import TaskCategory
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
        categories = TaskCategory.objects.filter(grammar__world=find_world(world))
        chosen = categories.filter(name=category).first()
        if chosen is None:
            names = ", ".join(categories.values_list("name", flat=True)) or "none"
            raise CommandError(f"“{world}” has no task category “{category}”. It has: {names}.")
        grammar = grammar_of(chosen)
        size = grammar.size()
        if size > limit:
            sentence = (
                f"Category “{category}” has up to {size:,} commands, more than the limit of "
                f"{limit:,}. Raise it with --limit."
            )
            raise RefusedReport({"size": size, "commands": None}, [sentence])
        return {"size": size, "commands": sum(1 for _ in grammar.commands(limit=limit))}
