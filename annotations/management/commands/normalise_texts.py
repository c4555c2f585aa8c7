"""``normalise_texts --world W``: normalises the texts of old rows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.normalising import normalise_world
from annotations.management.base import ReportingCommand, find_world


class Command(ReportingCommand):
    help = (
        "Removes what does not show from the stored texts of a world, and composes their letters. Rows that "
        "would be the same as another one then stay, and are named. Frozen splits and predictions stay too."
    )

    audited = "normalise texts"

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("--world", required=True)
        parser.add_argument(
            "--dry-run", action="store_true", help="says what it would do; changes nothing"
        )

    def report(self, *, world: str, dry_run: bool, **options: Any) -> Mapping[str, Any]:
        return normalise_world(find_world(world), dry_run).as_json()

    def audit_subject(self, report: Mapping[str, Any], options: Mapping[str, Any]) -> str:
        count = f"{sum(report['rows'].values()):,} rows"
        return f"{count}, as a trial" if report["is_dry_run"] else count
