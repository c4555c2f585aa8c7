"""Secrets that a page shows once: the link of an invitation, a token, the link for a new password.

A page that makes a secret answers with a redirect, so that a reload does not make a second one. The secret
is kept in the session of its maker until the next page shows it, then it is deleted.
"""

from __future__ import annotations

from django.http import HttpRequest


def keep(request: HttpRequest, name: str, secret: str) -> None:
    """Keep ``secret`` for the page that takes ``name`` next."""
    request.session[f"shown_once:{name}"] = secret


def take(request: HttpRequest, name: str) -> str:
    """Return the secret that waits under ``name`` and forget it; empty where there is none."""
    slot = f"shown_once:{name}"
    return str(request.session.pop(slot)) if slot in request.session else ""
