"""``manage.py parse_server``: the process that holds the promoted parsers and answers."""

from __future__ import annotations

from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError, CommandParser

from parser_service.serving.server_process import serve


class Command(BaseCommand):
    help = (
        "Hold the promoted parser of each world in memory and answer utterances, until stopped. Pages and "
        "REST ask it at PARSER_URL."
    )
    requires_system_checks = []

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("--host", default=settings.PARSER_HOST, help="default: PARSER_HOST")
        parser.add_argument(
            "--port", type=int, default=settings.PARSER_PORT, help="default: PARSER_PORT"
        )

    def handle(self, *args: Any, host: str, port: int, **options: Any) -> None:
        most_bytes = settings.PARSER_MEMORY_MB * 1_000_000
        try:
            serve(host, port, settings.PARSER_SECRET, most_bytes)
        except OSError as error:
            raise CommandError(f"Cannot serve on {host}:{port}: {error.strerror}.") from error
