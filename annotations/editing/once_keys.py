"""Keys that make a form idempotent: a form that is sent twice makes one row."""

from __future__ import annotations

import secrets

from django.core.cache import cache

from annotations.models import User

REMEMBERED_SECONDS = 24 * 3600


def new_key() -> str:
    """Return a key for a form that has not been sent yet."""
    return secrets.token_urlsafe(16)


def made_before(by: User, key: str) -> int | None:
    """Return the primary key of what ``by`` made with ``key``; None where that was nothing.

    Call it and ``remember`` in one transaction that holds a lock, so that the same request sent at
    the same time waits for the first.
    """
    return cache.get(_slot(by, key)) if key else None


def remember(by: User, key: str, made: int) -> None:
    """Keep for a day what ``by`` made with ``key``."""
    if key:
        cache.set(_slot(by, key), made, REMEMBERED_SECONDS)


def _slot(by: User, key: str) -> str:
    return f"once:{by.pk}:{key}"
