"""How much a request may bring. Files come from people who may import, and from nobody else."""

from __future__ import annotations

import re
from collections.abc import Callable

from django.conf import settings
from django.http import HttpRequest, HttpResponse
from rest_framework.exceptions import AuthenticationFailed

from annotations.api.authentication import TokenAuthentication
from annotations.models import Duty, User, World
from gpsr_site.web.refusals import refuse

ANONYMOUS_BYTES = 64 * 1024
ORDINARY_BYTES = 1024 * 1024
# What multipart/form-data adds around the files.
ENVELOPE_BYTES = 64 * 1024
WORLD_ADDRESS = "/worlds/import/"  # administrators of the site send archives of worlds there
UPLOAD_ADDRESS = re.compile(r"^/(?:(?:w|api/v1/worlds)/(?P<world>[-\w]+)|worlds)/import/")


def largest_body(path: str, is_logged_in: bool) -> int:
    """Return how many bytes a request to ``path`` may bring; more is answered with 413."""
    if not is_logged_in:
        return ANONYMOUS_BYTES
    if path == WORLD_ADDRESS or UPLOAD_ADDRESS.match(path):
        return settings.UPLOAD_MAX_BYTES + ENVELOPE_BYTES
    return ORDINARY_BYTES


class LimitBodies:
    """Middleware: answer 413 from ``Content-Length``, before any of the body is parsed.

    It stands behind Django's authentication, whose own work reads no body either, so that it knows
    whether the sender has logged in and may import into the world of the address.
    """

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        length = _content_length(request)
        if length <= ANONYMOUS_BYTES:
            return self.get_response(request)
        sender = _sender(request)
        if sender is None:
            return self._refuse(request, ANONYMOUS_BYTES, "Log in first.")
        if length <= ORDINARY_BYTES:
            return self.get_response(request)
        if not _may_import(sender, request.path):
            return self._refuse(
                request, ORDINARY_BYTES, "Only admins of a world send files, on its import page."
            )
        largest = largest_body(request.path, is_logged_in=True)
        if length > largest:
            return self._refuse(request, largest, "Send the files in several parts.")
        return self.get_response(request)

    def _refuse(self, request: HttpRequest, limit: int, hint: str) -> HttpResponse:
        sentence = f"This address takes no more than {limit // 1024:,} kB from you. {hint}"
        return refuse(request, 413, "Too much data", sentence)


def _content_length(request: HttpRequest) -> int:
    try:
        return int(request.META.get("CONTENT_LENGTH") or 0)
    except ValueError:
        return 0  # Django reads no body then


def _sender(request: HttpRequest) -> User | None:
    """Return who sends the request, by session or token; None for somebody unknown."""
    if request.user.is_authenticated:
        return request.user
    try:
        identity = TokenAuthentication().authenticate(request)
    except AuthenticationFailed:
        return None
    return identity[0] if identity else None


def _may_import(sender: User, path: str) -> bool:
    if path == WORLD_ADDRESS:
        return sender.is_superuser
    address = UPLOAD_ADDRESS.match(path)
    if not address:
        return False
    if address["world"] is None:
        return sender.is_superuser
    world = World.objects.visible_to(sender).filter(name=address["world"]).first()
    return world is not None and world.allows(sender, Duty.MANAGE)
