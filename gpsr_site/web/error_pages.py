"""Error pages: what people see instead of the page they asked for."""

from __future__ import annotations

import re
import sys
from typing import TypeGuard

from django.conf import settings
from django.core.exceptions import DisallowedHost
from django.db import InterfaceError, OperationalError
from django.http import HttpRequest, HttpResponse
from django.shortcuts import render

from annotations.background.failures import DAMAGED, disk_trouble, is_damaged
from annotations.models import World
from annotations.people.access import WorldRequest
from annotations.people.local_names import is_local_name
from annotations.people.members import admins_of
from annotations.rows.clashes import MADE_MEANWHILE, is_clash
from annotations.web.not_found import say_missing, where_to_look
from gpsr_site.web.refusals import refuse

WORLD_ADDRESS = re.compile(r"^/w/(?P<world>[-\w]+)/")
RETRY_SECONDS = 10
# How Django's reasons begin where a form does not come from the address that the site knows itself by.
OTHER_ADDRESS = ("Origin checking failed", "Referer checking failed")
# SQLSTATEs of a server that is away, overloaded, stopping, or too slow, and of two that waited for each
# other (PostgreSQL, appendix A).
OUTAGE_CODES = re.compile(r"08...|40P01|53(?!100)...|55P03|57014|57P0.|58...")
OUTAGE_WORDS = re.compile(r"locked|unable to open|disk I/O", re.IGNORECASE)


def bad_request(request: HttpRequest, exception: Exception) -> HttpResponse:
    """Answer 400: the request cannot be read, or its header ``Host`` is not in ``ALLOWED_HOSTS``."""
    if isinstance(exception, DisallowedHost):
        sentence = (
            f"This site does not answer under the name in the address of this page.{_names_for(request)} Whoever "
            "runs it adds a name to the variable ALLOWED_HOSTS."
        )
        return refuse(request, 400, "The site has another name", sentence, "other_host")
    return refuse(
        request,
        400,
        "This request cannot be read",
        "The address or the form was damaged on its way. Go back, reload the page and try again.",
        "bad_request",
    )


def permission_denied(request: HttpRequest, exception: Exception) -> HttpResponse:
    """Answer 403, inside the frame of the world that it is about."""
    if request.path.startswith("/api/"):
        return refuse(request, 403, "No access", str(exception), "permission_denied")
    if not _has_user(request):
        return refuse(request, 403, "No access", str(exception), "permission_denied")
    world = getattr(request, "world", None)
    context = {"sentence": str(exception), "admins": admins_of(world) if world else ()}
    return render(request, "403.html", context, status=403)


def not_found(request: HttpRequest, exception: Exception) -> HttpResponse:
    """Answer 404, inside the frame of the world in the address where the person may see that."""
    if request.path.startswith("/api/"):
        sentence = f"Nothing is at {request.path[:200]}. /api/v1/schema/ lists all addresses."
        return refuse(request, 404, "Not found", sentence, "not_found")
    if not _has_user(request):
        sentence = "Nothing is at this address."
        return refuse(request, 404, "Page not found", sentence, "not_found")
    # The page gets the rail of the world in its address, if the person may see that world.
    address = WORLD_ADDRESS.match(request.path)
    if address is not None and not hasattr(request, "world"):
        seen = World.objects.seen_by(request.user, address["world"])
        if seen is not None:
            request.world, request.duties = seen
    where = where_to_look(exception, request.path)
    context = {"sentence": say_missing(exception, request.path), "where": where}
    return render(request, "404.html", context, status=404)


def server_error(request: HttpRequest) -> HttpResponse:
    """Answer 507 where the disk cannot be written, 503 where the database is away or busy, 409 where somebody
    has stored the same at the same moment, 500 for whatever else no view has handled."""
    error = sys.exc_info()[1]
    if error is not None and (trouble := disk_trouble(error)):
        return refuse(
            request,
            507,
            trouble.name,
            "Your last step was not saved. What was saved before is still there, and pages can be read. Tell "
            f"whoever runs this site. {trouble.remedy}, then send it again.",
            "disk_not_writable",
        )
    if error is not None and is_damaged(error):
        return refuse(request, 500, "The database is damaged", DAMAGED, "database_damaged")
    if is_outage(error):
        response = refuse(
            request,
            503,
            "The database does not answer",
            "Nothing that was saved is lost, but your last step was not carried out. "
            f"Try again in {RETRY_SECONDS} seconds; if it stays so, tell whoever runs this site.",
            "database_away",
        )
        response["Retry-After"] = str(RETRY_SECONDS)
        return response
    if is_clash(error):
        return refuse(request, 409, "Somebody was faster", MADE_MEANWHILE, "made_meanwhile")
    return refuse(
        request,
        500,
        "Something went wrong on the server",
        "Nothing that was saved is lost, but your last step may not have been carried out. Go back "
        "and try again; if it happens again, tell whoever runs this site at what time: the log has "
        "the details.",
        "server_error",
    )


def csrf_failure(request: HttpRequest, reason: str = "") -> HttpResponse:
    """Answer 403 for a form that does not come from a page of this site, or from one that is too old."""
    if reason.startswith(OTHER_ADDRESS):
        return refuse(
            request,
            403,
            "This form comes from another address",
            f"Your browser says that the form stands at {_origin_of(request)}. The site knows itself as "
            f"{request.scheme}://{request.get_host()}. Open it under that address. If a proxy stands between, "
            "whoever runs the site sets HTTPS=true where the proxy speaks HTTPS, and lets it hand on the header "
            "Host; a name is added to ALLOWED_HOSTS, any other address to CSRF_TRUSTED_ORIGINS.",
            "other_origin",
        )
    return refuse(
        request,
        403,
        "This form has expired",
        "It was opened before you last logged in or out, or your browser refuses cookies. Go back, "
        "reload the page and send it again.",
        "form_expired",
    )


def _origin_of(request: HttpRequest) -> str:
    """Return where a browser says that a form stands, without what follows the name of a page."""
    headers = request.headers
    said = headers.get("Origin") or headers.get("Referer") or "an address that it does not tell"
    return "/".join(said[:200].split("/")[:3])


def _names_for(request: HttpRequest) -> str:
    """Return a sentence with the names of the site, for who asks from its own computer; empty for others."""
    if not is_local_name(str(request.META.get("REMOTE_ADDR", ""))):
        return ""
    return f" It answers as {', '.join(settings.ALLOWED_HOSTS)}."


def is_outage(error: BaseException | None) -> bool:
    """Return whether a database error says that the database is away or busy."""
    if isinstance(error, InterfaceError):
        return True
    if not isinstance(error, OperationalError):
        return False
    cause = error.__cause__
    if cause is not None and hasattr(cause, "sqlstate"):
        return cause.sqlstate is None or OUTAGE_CODES.fullmatch(cause.sqlstate) is not None
    return OUTAGE_WORDS.search(str(error)) is not None


def _has_user(request: HttpRequest) -> TypeGuard[WorldRequest]:
    """Return whether somebody is logged in; False also where the request never got so far."""
    user = getattr(request, "user", None)
    return user is not None and user.is_authenticated
