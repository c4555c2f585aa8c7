"""The web server alone, without a worker."""

from __future__ import annotations

from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError, CommandParser

from gpsr_site.processes import Supervisor, web_server_commands
from gpsr_site.web.server import require_free_port, serve
from gpsr_site.wsgi import application


class Command(BaseCommand):
    help = (
        "Serve pages and API on HOST:PORT until stopped, with WEB_PROCESSES processes; run `migrate` and "
        "`collectstatic` first."
    )

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument(
            "--share-port", action="store_true", help="be one of several servers on this port"
        )

    def handle(self, *args: Any, share_port: bool, **options: Any) -> None:
        try:
            if share_port or settings.WEB_PROCESSES == 1:
                serve(application, settings.HOST, settings.PORT, share_port)
            else:
                self.supervise()
        except OSError as error:
            raise CommandError(
                f"Cannot serve on {settings.HOST}:{settings.PORT}: {error.strerror}."
            ) from error

    def supervise(self) -> None:
        require_free_port(settings.HOST, settings.PORT)
        servers = Supervisor(web_server_commands(settings.WEB_PROCESSES), self.stdout.write)
        servers.start()
        servers.watch()
