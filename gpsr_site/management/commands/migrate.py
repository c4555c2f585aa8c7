"""Django's ``migrate``, which names the rows that do not fit into the new tables."""

from __future__ import annotations

from typing import Any

from django.core.checks import Tags
from django.core.management.base import CommandError
from django.core.management.commands import migrate
from django.db import DataError, IntegrityError

from gpsr_site.backup.unfit_rows import is_before_squash, say_unfit_rows


class Command(migrate.Command):
    requires_system_checks = (Tags.database, Tags.models)  # the others load all pages, for a second

    def handle(self, *args: Any, **options: Any) -> str | None:
        if is_before_squash():
            raise CommandError(
                "This database is older than commit 7eb91d0. Check that commit out, run there: make install, "
                "gpsr-workbench manage migrate. Then upgrade from it to this version."
            )
        try:
            return super().handle(*args, **options)
        except (IntegrityError, DataError) as error:
            if said := say_unfit_rows():
                raise CommandError(said) from error
            raise
