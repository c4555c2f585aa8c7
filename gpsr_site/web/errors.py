"""What people see instead of the page they asked for."""

from __future__ import annotations

import re
import sys

from django.db import InterfaceError, OperationalError
from django.http import HttpRequest, HttpResponse
from django.shortcuts import render

from annotations.models import World
from annotations.people.members import admins_of
from gpsr_site.web.refusals import refuse

WORLD_ADDRESS = re.compile(r"^/w/(?P<world>[-\w]+)/")
RETRY_SECONDS = 10
# SQLSTATEs of a server that is away, overloaded, stopping, or too slow (PostgreSQL, appendix A).
OUTAGE_CODES = re.compile(r"08...|53...|55P03|57014|57P0.|58...")
OUTAGE_WORDS = re.compile(r"locked|unable to open|disk I/O|is full", re.IGNORECASE)


def bad_request(request: HttpRequest, exception: Exception) -> HttpResponse:
    """Answer 400: what was sent cannot be read, or names a host that this site is not."""
    return refuse(
        request,
        400,
        "This request cannot be read",
        "The address or the form was damaged on its way. Go back, reload the page and try again.",
    )


def permission_denied(request: HttpRequest, exception: Exception) -> HttpResponse:
    """Answer 403, inside the frame of the world that it is about."""
    if request.path.startswith("/api/"):
        return refuse(request, 403, "No access", str(exception))
    if not _has_user(request):
        return refuse(request, 403, "No access", str(exception))
    world = getattr(request, "world", None)
    context = {"sentence": str(exception), "admins": admins_of(world) if world else ()}
    return render(request, "403.html", context, status=403)


def not_found(request: HttpRequest, exception: Exception) -> HttpResponse:
    """Answer 404, inside the frame of the world in the address where the person may see that."""
    if request.path.startswith("/api/"):
        return refuse(request, 404, "Not found", f"Nothing is at {request.path}.")
    if not _has_user(request):
        return refuse(request, 404, "Page not found", "Nothing is at this address.")
    _enter_world(request)
    return render(request, "404.html", {"path": request.path}, status=404)


def server_error(request: HttpRequest) -> HttpResponse:
    """Answer 503 where the database is away or busy; 500 for whatever else no view has handled."""
    if is_outage(sys.exc_info()[1]):
        response = refuse(
            request,
            503,
            "The database does not answer",
            "Nothing that was saved is lost, but your last step was not carried out. "
            f"Try again in {RETRY_SECONDS} seconds; if it stays so, tell whoever runs this site.",
        )
        response["Retry-After"] = str(RETRY_SECONDS)
        return response
    return refuse(
        request,
        500,
        "Something went wrong on the server",
        "Nothing that was saved is lost, but your last step may not have been carried out. Go back "
        "and try again; if it happens again, tell whoever runs this site at what time: the log has "
        "the details.",
    )


def csrf_failure(request: HttpRequest, reason: str = "") -> HttpResponse:
    """Answer 403 for a form that does not come from a page of this site, or from one that is too old."""
    return refuse(
        request,
        403,
        "This form has expired",
        "It was opened before you last logged in or out, or your browser refuses cookies. Go back, "
        "reload the page and send it again.",
    )


def is_outage(error: BaseException | None) -> bool:
    """Return whether a database error says that the database is away or busy."""
    if isinstance(error, InterfaceError):
        return True
    if not isinstance(error, OperationalError):
        return False
    cause = error.__cause__
    if hasattr(cause, "sqlstate"):
        return cause.sqlstate is None or OUTAGE_CODES.fullmatch(cause.sqlstate) is not None
    return OUTAGE_WORDS.search(str(error)) is not None


def _has_user(request: HttpRequest) -> bool:
    """Return whether somebody is logged in; False also where the request never got so far."""
    user = getattr(request, "user", None)
    return user is not None and user.is_authenticated


def _enter_world(request: HttpRequest) -> None:
    """Give the page the rail of the world in its address, if the person may see that world."""
    address = WORLD_ADDRESS.match(request.path)
    if address is None or hasattr(request, "world"):
        return
    if seen := World.objects.seen_by(request.user, address["world"]):
        request.world, request.duties = seen
