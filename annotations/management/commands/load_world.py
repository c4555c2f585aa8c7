"""``load_world NAME --world W``: loads a world that comes with this project."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.shipped_worlds import SHIPPED_WORLDS, load_world
from annotations.management.base import ReportingCommand


class Command(ReportingCommand):
    help = (
        "Loads a world that comes with this project: its ontology, grammar, templates, commands and paraphrases, "
        "with two splits. Refused where the world holds something already."
    )

    audited = "load a world"

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("name", choices=SHIPPED_WORLDS)
        parser.add_argument("--world", required=True, help="a new world, or an empty one")

    def report(self, *, name: str, world: str, **options: Any) -> Mapping[str, Any]:
        return load_world(SHIPPED_WORLDS[name], world).as_json()

    def audit_subject(self, report: Mapping[str, Any], options: Mapping[str, Any]) -> str:
        return str(options["name"])
