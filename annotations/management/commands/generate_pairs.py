"""``generate_pairs NAME``: makes the commands of a world, with their logical forms."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.core.management.base import CommandParser

from annotations.generating import generate_pairs
from annotations.language.expansion import DEFAULT_LIMIT
from annotations.management.base import ReportingCommand, find_world


class Command(ReportingCommand):
    help = "Generates the commands of a world, with their logical forms, from its templates."

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument("--limit", type=int, default=DEFAULT_LIMIT, help="refuse more commands")

    def report(self, *, world: str, limit: int, **options: Any) -> Mapping[str, Any]:
        return generate_pairs(find_world(world), limit).as_json()
