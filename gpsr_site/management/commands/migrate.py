"""Django's ``migrate``, which names the rows that do not fit into the new tables."""

from __future__ import annotations

from typing import Any

from django.core.management.base import CommandError
from django.core.management.commands import migrate
from django.db import DataError, IntegrityError

from gpsr_site.backup.unfit_rows import say_unfit_rows


class Command(migrate.Command):
    def handle(self, *args: Any, **options: Any) -> str | None:
        try:
            return super().handle(*args, **options)
        except (IntegrityError, DataError) as error:
            if said := say_unfit_rows():
                raise CommandError(said) from error
            raise
