"""Write the audit log: one entry for each request that has changed something.

Middleware of the site calls ``record`` in one place, so that no page or route can be forgotten. A page declares
what it does (``access.plain_view``); a route does what its method and name say. Either may say with ``note`` what
its address does not. Commands that change something call ``record_command``.
"""

from __future__ import annotations

import logging
import re
from datetime import datetime
from typing import Any

from django.db import DatabaseError, transaction
from django.http import HttpRequest, HttpResponse
from django.urls import ResolverMatch

from annotations.models import ApiToken, AuditEntry, Scope, World
from annotations.people.access import NOTHING

logger = logging.getLogger(__name__)

# Who does what a management command does, and what nobody has asked for.
COMMAND_LINE, RULE = "command line", "rule"
MOST_AT_ONCE = 5_000  # entries that are deleted in one transaction
SAFE_METHODS = ("GET", "HEAD", "OPTIONS", "TRACE")
VERBS = {"POST": "create", "PUT": "change", "PATCH": "change", "DELETE": "delete"}


def note(request: HttpRequest, sentence: str) -> None:
    """Say in the audit log what the request was about, of a page or of the API; never a secret."""
    plain: Any = getattr(request, "_request", request)  # the one below that of a route
    plain.audit_note = sentence


def record(request: HttpRequest, response: HttpResponse) -> AuditEntry | None:
    """Write down what ``request`` has done; None for one that has changed nothing."""
    match = request.resolver_match
    if match is None or not _has_done_something(request, match, response):
        return None
    assert request.user.is_authenticated
    token, world = getattr(request, "auth", None), getattr(request, "world", None)
    name = world.name if world else match.kwargs.get("world")
    # None where the request has just deleted it.
    world = World.objects.filter(name=name).first() if name else None
    # What a view has noted, else the kind and key of the row that the address names.
    names = ("kind", "split", "subject", "pk", "object_id")
    row = " ".join(str(match.kwargs[each]) for each in names if each in match.kwargs)
    subject = str(getattr(request, "audit_note", "") or row)
    return AuditEntry.objects.create(
        world=world,
        world_name=world.name if world else "",
        who=request.user,
        who_name=request.user.get_username(),
        through=token.name if isinstance(token, ApiToken) else "",
        what=_what(request, match),
        subject=subject,
    )


def record_command(
    what: str, subject: str = "", world: World | None = None, who: str = COMMAND_LINE
) -> None:
    """Write down what a management command or a rule has done; it stays done where that fails."""
    try:
        with transaction.atomic():
            AuditEntry.objects.create(
                world=world,
                world_name=world.name if world else "",
                who_name=who,
                what=what,
                subject=subject,
            )
    except DatabaseError:
        logger.exception("An entry of the audit log could not be written.")


def prune(before: datetime, world: World | None = None) -> int:
    """Delete the entries from before a moment, of one world or of all, and return how many they were.

    In short transactions, so that people work meanwhile.
    """
    old = AuditEntry.objects.filter(at__lt=before).order_by("pk")
    if world is not None:
        old = old.filter(world=world)
    count = 0
    while keys := list(old.values_list("pk", flat=True)[:MOST_AT_ONCE]):
        AuditEntry.objects.filter(pk__in=keys).delete()
        count += len(keys)
    return count


def _has_done_something(request: HttpRequest, match: ResolverMatch, response: HttpResponse) -> bool:
    if request.method in SAFE_METHODS or response.status_code >= 400:
        return False
    if not request.user.is_authenticated or getattr(match.func, "does", "") == NOTHING:
        return False
    if _is_api(match):
        method, route = request.method or "", getattr(match.func, "cls", None)
        asked = getattr(match.func, "actions", {}).get(method.lower(), method)
        only_reads = getattr(route, "scopes", {}).get(asked) == Scope.READ
        return not only_reads and asked not in getattr(route, "unrecorded", ())
    # A page that answers a form with itself has refused it, unless it says otherwise.
    is_htmx = bool(getattr(request, "htmx", False))
    return response.status_code != 200 or is_htmx or hasattr(request, "audit_note")


def _is_api(match: ResolverMatch) -> bool:
    return "api" in match.namespaces


def _what(request: HttpRequest, match: ResolverMatch) -> str:
    name = match.url_name or ""
    if name.endswith("-list"):  # of a view set: its address has the plural
        name = match.route.strip("/").rpartition("/")[2]
    words = re.sub(r"[_-]+", " ", name.removesuffix("-detail"))
    if _is_api(match):
        return f"{VERBS[request.method or '']} {words}"
    if "admin" in match.namespaces:
        return f"site administration: {words}"
    said: str = getattr(match.func, "does", words)  # a view of another project declares nothing
    return said
