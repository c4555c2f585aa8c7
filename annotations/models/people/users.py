"""Accounts."""

from __future__ import annotations

from typing import Any

from django.contrib.auth.models import AbstractUser
from django.db import transaction


class User(AbstractUser):
    """A person with an account. What they may do is said by their memberships, per world."""

    def save(self, *args: Any, **kwargs: Any) -> None:
        """Save the account. A new password ends its tokens and its log-ins."""
        has_new_password = self._password is not None and self.pk is not None
        with transaction.atomic():
            super().save(*args, **kwargs)
            if has_new_password:
                self.api_tokens.all().delete()
                self.log_in_sessions.all().delete()
