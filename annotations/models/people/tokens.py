"""The tokens by which programs act for people."""

from __future__ import annotations

import hashlib
import secrets
from datetime import timedelta

from django.db import models
from django.utils import timezone

from annotations.models.people.users import User


class Scope(models.TextChoices):
    """What a token may be used for, within what its owner may do. Each includes those before it."""

    READ = "read"
    ANNOTATE = "annotate"
    TRAIN = "train"
    ADMIN = "admin"

    def includes(self, other: Scope) -> bool:
        """Return whether a token of this scope may do what ``other`` allows."""
        order = list(Scope)
        return order.index(other) <= order.index(self)


def scope_choices() -> list[tuple[str, str]]:
    return Scope.choices


class ApiTokenQuerySet(models.QuerySet["ApiToken"]):
    def valid(self) -> ApiTokenQuerySet:
        return self.filter(expires_at__gt=timezone.now(), user__is_active=True)

    def for_key(self, key: str) -> ApiToken | None:
        """Return the valid token whose secret is ``key``, or None."""
        return self.valid().select_related("user").filter(digest=digest_of(key)).first()


class ApiToken(models.Model):
    """A hashed, expiring secret of an API client. The secret itself is shown once and never stored."""

    user = models.ForeignKey(User, on_delete=models.CASCADE, related_name="api_tokens")
    name = models.CharField(max_length=80)
    scope = models.CharField(max_length=10, choices=scope_choices)
    digest = models.CharField(max_length=64, unique=True)
    created_at = models.DateTimeField(auto_now_add=True)
    expires_at = models.DateTimeField()

    objects = ApiTokenQuerySet.as_manager()

    def __str__(self) -> str:
        return f"{self.name} of {self.user}"

    @classmethod
    def issue(
        cls,
        user: User,
        name: str,
        days: int = 90,
        scope: Scope = Scope.ADMIN,
        by: ApiToken | None = None,
    ) -> tuple[ApiToken, str]:
        """Issue a token and return it with its secret, which cannot be retrieved later.

        One that a program makes by another token expires with that one, at the latest.
        """
        key = secrets.token_urlsafe(32)
        expires_at = timezone.now() + timedelta(days=days)
        expires_at = min(expires_at, by.expires_at) if by else expires_at
        token = cls.objects.create(
            user=user, name=name, scope=scope, digest=digest_of(key), expires_at=expires_at
        )
        return token, key


def digest_of(key: str) -> str:
    """Return the SHA-256 in hexadecimal; enough for a secret of 256 random bits."""
    return hashlib.sha256(key.encode("utf-8", "surrogatepass")).hexdigest()
