"""``prune_audit_log --older-than DAYS``: deletes old entries of the audit log."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import timedelta
from typing import Any

from django.core.management.base import CommandParser
from django.utils import timezone

from annotations.language.texts import Refusal
from annotations.management.base import ReportingCommand, find_world
from annotations.people.audit_log import prune


class Command(ReportingCommand):
    help = (
        "Deletes the entries of the audit log that are older than a number of days, of one world or of "
        "all. That it did so is an entry itself."
    )
    audited = "prune the audit log"

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("--older-than", type=int, required=True, metavar="DAYS")
        parser.add_argument("--world", help="only the entries of this world")

    def report(self, *, older_than: int, world: str | None, **options: Any) -> Mapping[str, Any]:
        if older_than < 1:
            raise Refusal(
                f"--older-than is {older_than}; it has to be one day or more.", "days_too_few"
            )
        try:
            before = timezone.now() - timedelta(days=older_than)
        except OverflowError:
            raise Refusal(
                f"--older-than is {older_than} days, before there were any.", "days_too_many"
            ) from None
        chosen = find_world(world) if world else None
        return {"before": before.isoformat(timespec="seconds"), "deleted": prune(before, chosen)}

    def audit_subject(self, report: Mapping[str, Any], options: Mapping[str, Any]) -> str:
        return f"{report['deleted']} entries from before {report['before']}"
