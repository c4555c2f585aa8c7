"""Django's ``createsuperuser``, in the audit log."""

from __future__ import annotations

from typing import Any

from django.contrib.auth.management.commands import createsuperuser

from annotations.models import User
from annotations.people.audit_log import record_command


class Command(createsuperuser.Command):
    def handle(self, *args: Any, **options: Any) -> str | None:
        last = User.objects.order_by("pk").last()
        answer = super().handle(*args, **options)
        for user in User.objects.filter(pk__gt=last.pk if last else 0, is_superuser=True):
            record_command("make an account", f"{user.get_username()}, administrator of the site")
        return answer
