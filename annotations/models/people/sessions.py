"""Log-ins: Django's sessions, which also say whose they are, so that people can see and end theirs."""

from __future__ import annotations

from datetime import datetime
from hashlib import sha256
from typing import Any

from django.contrib.sessions.backends.db import SessionStore as DatabaseStore
from django.contrib.sessions.base_session import AbstractBaseSession
from django.db import models

from annotations.models.people.users import User


class LogInSession(AbstractBaseSession):
    """A browser in which somebody is logged in, or nobody yet. Written by ``SessionStore`` alone."""

    user = models.ForeignKey(
        User, null=True, on_delete=models.CASCADE, related_name="log_in_sessions"
    )
    device = models.CharField(max_length=200, blank=True)
    begun_at = models.DateTimeField(null=True)

    @classmethod
    def get_session_store_class(cls) -> type[SessionStore]:
        return SessionStore

    @property
    def handle(self) -> str:
        """Return what pages call the session by; its key would let anybody in."""
        return sha256(self.session_key.encode()).hexdigest()[:16]


class SessionStore(DatabaseStore):
    """The session engine (``SESSION_ENGINE``): keeps whose session it is beside its data."""

    @classmethod
    def get_model_class(cls) -> type[LogInSession]:
        return LogInSession

    def create_model_instance(self, data: dict[str, Any]) -> LogInSession:
        row: LogInSession = super().create_model_instance(data)
        user, begun_at = data.get("_auth_user_id"), data.get("begun_at")
        row.user_id = int(user) if user else None
        row.device = data.get("device", "")
        row.begun_at = datetime.fromisoformat(begun_at) if begun_at else None
        return row
