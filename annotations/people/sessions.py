"""Verbs: see where one is logged in, and end it."""

from __future__ import annotations

from django.http import HttpRequest
from django.utils import timezone

from annotations.models import LogInSession, User

MOST_DEVICE_CHARACTERS = 200


def remember_device(request: HttpRequest) -> None:
    """Keep in the session what browser somebody has just logged in with."""
    device = request.headers.get("User-Agent", "").replace("\0", "")
    request.session["device"] = device.encode(errors="replace").decode()[:MOST_DEVICE_CHARACTERS]
    request.session["begun_at"] = timezone.now().isoformat()


def sessions_of(user: User) -> list[LogInSession]:
    """Return where ``user`` is logged in, the newest first."""
    rows = LogInSession.objects.filter(user=user, expire_date__gt=timezone.now())
    return sorted(rows, key=lambda each: each.begun_at or each.expire_date, reverse=True)


def end_session(user: User, handle: str) -> bool:
    """Log ``user`` out where the session called ``handle`` is; False where there is none."""
    keys = [each.pk for each in sessions_of(user) if each.handle == handle]
    return LogInSession.objects.filter(pk__in=keys).delete()[0] > 0
