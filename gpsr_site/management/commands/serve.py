"""The web server alone, without a worker."""

from __future__ import annotations

from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError

from gpsr_site.web.server import serve
from gpsr_site.wsgi import application


class Command(BaseCommand):
    help = (
        "Serve pages and API on HOST:PORT until stopped; run `migrate` and `collectstatic` first."
    )

    def handle(self, *args: Any, **options: Any) -> None:
        try:
            serve(application, settings.HOST, settings.PORT)
        except OSError as error:
            raise CommandError(
                f"Cannot serve on {settings.HOST}:{settings.PORT}: {error.strerror}."
            ) from error
