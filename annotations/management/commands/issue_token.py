"""Make an API token and print its secret once."""

from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from annotations.models import ApiToken, Scope
from annotations.people.audit_log import record_command
from annotations.people.members import find_account


class Command(BaseCommand):
    help = "Issue an API token for an account. The secret is printed once and stored only hashed."

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("username")
        parser.add_argument("--name", default="command line", help="what the token is for")
        parser.add_argument("--days", type=int, default=90, help="days until it expires")
        parser.add_argument("--scope", choices=Scope.values, default=Scope.READ)

    def handle(self, *args: Any, **options: Any) -> None:
        user = find_account(options["username"])
        if user is None:
            raise CommandError(
                f"There is no active account {options['username']!r}. "
                "Invite somebody on the people page of a world, or run: gpsr-workbench manage createsuperuser"
            )
        if options["days"] < 1:
            raise CommandError(f"--days is {options['days']}; a token lasts at least one day.")
        token, key = ApiToken.issue(user, options["name"], options["days"], options["scope"])
        record_command("make a token", f"{token.name} ({token.scope}) for {user.get_username()}")
        self.stdout.write(key)
