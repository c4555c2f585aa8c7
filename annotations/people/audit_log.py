"""Writes the audit log: one entry for each request that has changed something.

Middleware of the site calls ``record`` in one place, so that no page or route can be forgotten. A view
may say with ``note`` what its address does not.
"""

from __future__ import annotations

import re

from django.http import HttpRequest, HttpResponse

from annotations.models import ApiToken, AuditEntry, Scope, World

SAFE_METHODS = ("GET", "HEAD", "OPTIONS", "TRACE")
MOST_SUBJECT_CHARACTERS = 200
# Routes that are posted to and change nothing that others see.
UNRECORDED = re.compile(
    r"_(check|preview|suggestions|completion|consequences)$"
    r"|^(draft|inbox|notice_open|queue_next|work-item-next|tryout_ask|playground_ask)$"
)
VERBS = {"POST": "create", "PUT": "change", "PATCH": "change", "DELETE": "delete"}
# What a route does where its name does not say it.
WHAT = {
    "login": "log in",
    "join": "join",
    "password": "change password",
    "account_close": "close or open an account",
    "account_link": "make a link for a new password",
    "token_new": "make a token",
    "token_revoke": "revoke a token",
    "session_end": "log out elsewhere",
    "people": "add a member",
    "member": "change roles",
    "invite": "invite",
    "invitation_withdraw": "withdraw an invitation",
    "world_new": "create a world",
    "world_import": "import a world",
    "world_delete": "delete the world",
    "import": "import files",
    "import_pairs": "import pairs",
    "generate": "generate commands",
    "history": "restore a version",
    "deleted": "restore a deleted row",
    "delete_row": "delete",
    "comments": "comment",
    "comment": "change a comment",
    **{name: f"change {name}" for name in ("template", "entity", "predicate", "production")},
    **{f"{name}_new": f"new {name}" for name in ("template", "entity", "predicate", "production")},
    "split_new": "freeze a split",
    "run_new": "start a run",
    "run_cancel": "cancel a run",
    "promotion_promote": "promote a run",
    "promotion_roll_back": "roll back to the run before",
    "promotion_decline": "decline a proposed run",
    "playground_wrong": "report a wrong answer",
    "label_answer": "label",
    "label_take_back": "take a label back",
    "queue_settings": "set shares",
}


def note(request: HttpRequest, sentence: str) -> None:
    """Say in the audit log what the request was about; never a secret."""
    request.audit_note = sentence


def record(request: HttpRequest, response: HttpResponse) -> AuditEntry | None:
    """Write down what ``request`` has done; None for one that has changed nothing."""
    if not _has_done_something(request, response):
        return None
    token, world = getattr(request, "auth", None), _world_of(request)
    return AuditEntry.objects.create(
        world=world,
        world_name=world.name if world else "",
        who=request.user,
        who_name=request.user.get_username(),
        through=token.name if isinstance(token, ApiToken) else "",
        what=_what(request)[:80],
        subject=_subject(request)[:MOST_SUBJECT_CHARACTERS],
    )


def _has_done_something(request: HttpRequest, response: HttpResponse) -> bool:
    match = request.resolver_match
    if request.method in SAFE_METHODS or response.status_code >= 400 or match is None:
        return False
    if not request.user.is_authenticated or UNRECORDED.search(match.url_name or ""):
        return False
    if _is_api(request):
        scopes = getattr(getattr(match.func, "cls", None), "scopes", {})
        return scopes.get(request.method) != Scope.READ
    # A page that answers a form with itself has refused it, unless it says otherwise.
    return response.status_code != 200 or bool(request.htmx) or hasattr(request, "audit_note")


def _is_api(request: HttpRequest) -> bool:
    return "api" in request.resolver_match.namespaces


def _what(request: HttpRequest) -> str:
    match = request.resolver_match
    words = re.sub(r"[_-]+", " ", match.url_name or "")
    if _is_api(request):
        return f"{VERBS[request.method]} {words}"
    if "admin" in match.namespaces:
        return f"site administration: {words}"
    return WHAT.get(match.url_name, words)


def _subject(request: HttpRequest) -> str:
    """Return what a view has noted, else the kind and key of the row that the address names."""
    if sentence := getattr(request, "audit_note", ""):
        return str(sentence)
    keys = request.resolver_match.kwargs
    names = (
        str(keys[name]) for name in ("kind", "split", "subject", "pk", "object_id") if name in keys
    )
    return " ".join(names)


def _world_of(request: HttpRequest) -> World | None:
    """Return the world of the request, unless the request has just deleted it."""
    world = getattr(request, "world", None)
    name = world.name if world else request.resolver_match.kwargs.get("world")
    return World.objects.filter(name=name).first() if name else None
