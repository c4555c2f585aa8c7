"""Django's ``changepassword``, in the audit log."""

from __future__ import annotations

from getpass import getuser
from typing import Any

from django.contrib.auth.management.commands import changepassword

from annotations.people.audit_log import record_command


class Command(changepassword.Command):
    def handle(self, *args: Any, **options: Any) -> str | None:
        answer = super().handle(*args, **options)  # raises where the password stays as it is
        record_command("change password", f"of {options['username'] or getuser()}")
        return answer
