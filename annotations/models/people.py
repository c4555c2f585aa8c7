"""Accounts, the tokens of their programs, and their log-ins."""

from __future__ import annotations

import hashlib
import secrets
from datetime import datetime, timedelta
from hashlib import sha256
from typing import TYPE_CHECKING, Any, ClassVar

from django.contrib.auth.models import AbstractUser, UserManager
from django.contrib.sessions.backends.db import SessionStore as DatabaseStore
from django.contrib.sessions.base_session import AbstractBaseSession
from django.db import models, transaction
from django.utils import timezone

from annotations.models.short_texts import ShortTextField


class Accounts(UserManager["User"]):
    """Accounts, which are known by their names in any case: who is called Carla logs in as carla."""

    use_in_migrations = False

    def alike(self, name: str) -> list[User]:
        """Return the accounts called ``name`` in any case."""
        wanted = User.normalize_username(name)
        # SQLite knows the case of ASCII letters alone: the usual spellings of others are looked up.
        spellings = {wanted, wanted.lower(), wanted.upper(), wanted.title(), wanted.capitalize()}
        rows = self.filter(
            models.Q(username__iexact=wanted) | models.Q(username__in=sorted(spellings))
        )
        return list(rows.order_by("pk"))

    def named(self, name: str) -> User | None:
        """Return the account called ``name``, else the only one whose name differs in case alone."""
        rows = self.alike(name)
        exact = [row for row in rows if row.username == User.normalize_username(name)]
        return exact[0] if exact else rows[0] if len(rows) == 1 else None

    def get_by_natural_key(self, username: str | None) -> User:
        """Return the account that somebody logs in to by this name. Raises DoesNotExist."""
        account = self.named(username or "")
        if account is None:
            raise User.DoesNotExist
        return account


class User(AbstractUser):
    """A person with an account. What they may do is said by their memberships, per world."""

    objects: ClassVar[Accounts] = Accounts()

    if TYPE_CHECKING:
        _password: str | None  # the new one, until it is saved

    def save(self, *args: Any, **kwargs: Any) -> None:
        """Save the account. A new password ends its tokens and its log-ins."""
        has_new_password = self._password is not None and self.pk is not None
        with transaction.atomic():
            super().save(*args, **kwargs)
            if has_new_password:
                self.api_tokens.all().delete()
                self.log_in_sessions.all().delete()


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


class LogInSession(AbstractBaseSession):
    """A browser in which somebody is logged in, or nobody yet. Written by ``SessionStore`` alone."""

    user = models.ForeignKey(
        User, null=True, on_delete=models.CASCADE, related_name="log_in_sessions"
    )
    device = ShortTextField(max_length=200, blank=True)
    begun_at = models.DateTimeField(null=True)

    @classmethod
    def get_session_store_class(cls) -> type[SessionStore]:
        return SessionStore

    @property
    def handle(self) -> str:
        """Return what pages call the session by; its key would let anybody in."""
        return sha256(self.session_key.encode()).hexdigest()[:16]


if TYPE_CHECKING:
    StoreOfLogIns = DatabaseStore[LogInSession]
else:  # Django's class takes no type argument at run time
    StoreOfLogIns = DatabaseStore


class SessionStore(StoreOfLogIns):
    """The session engine (``SESSION_ENGINE``): keeps whose session it is beside its data."""

    @classmethod
    def get_model_class(cls) -> type[LogInSession]:
        return LogInSession

    def create_model_instance(self, data: dict[str, Any]) -> LogInSession:
        row = super().create_model_instance(data)
        user, begun_at = data.get("_auth_user_id"), data.get("begun_at")
        row.user_id = int(user) if user else None
        row.device = data.get("device", "")
        row.begun_at = datetime.fromisoformat(begun_at) if begun_at else None
        return row
