"""Accounts, the tokens of their programs, and their log-ins."""

from __future__ import annotations

from annotations.models.people.sessions import LogInSession
from annotations.models.people.tokens import ApiToken, Scope, digest_of, scope_choices
from annotations.models.people.users import User

__all__ = [
    "ApiToken",
    "LogInSession",
    "Scope",
    "User",
    "digest_of",
    "scope_choices",
]
