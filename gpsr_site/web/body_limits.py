"""How much a request may bring. Files go to the views that take them, from people who may send them there."""

from __future__ import annotations

from collections.abc import Callable

from django.conf import settings
from django.http import HttpRequest, HttpResponse
from rest_framework.exceptions import AuthenticationFailed

from annotations.models import User, World
from annotations.people.access import WHO_MAY
from annotations.people.allowances import Allowance, allowance_at
from annotations.web.rest.authentication import TokenAuthentication
from gpsr_site.web.refusals import refuse

ANONYMOUS_BYTES = 64 * 1024
ORDINARY_BYTES = 1024 * 1024
# What multipart/form-data adds around the files.
ENVELOPE_BYTES = 64 * 1024


class LimitBodies:
    """Middleware: answer 413 from ``Content-Length``, before any of the body is parsed.

    It stands behind Django's authentication, whose own work reads no body either, so that it knows
    whether the sender has logged in and may send files to the address.
    """

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        try:
            length = int(request.META.get("CONTENT_LENGTH") or 0)
        except ValueError:
            length = 0  # Django reads no body then
        if length <= ANONYMOUS_BYTES:
            return self.get_response(request)
        sender = _sender(request)
        if sender is None:
            return self._refuse(request, ANONYMOUS_BYTES, "Log in first.")
        if length <= ORDINARY_BYTES:
            return self.get_response(request)
        allowance = allowance_at(request.path_info)
        if not allowance.takes_files:
            return self._refuse(request, ORDINARY_BYTES, "It takes no files.")
        if not _may_send_files(sender, allowance):
            who = WHO_MAY[allowance.duty] if allowance.duty else "administrators of this site"
            return self._refuse(request, ORDINARY_BYTES, f"Only {who} send files here.")
        largest = settings.UPLOAD_MAX_BYTES + ENVELOPE_BYTES
        if length > largest:
            return self._refuse(request, largest, "Send the files in several parts.")
        return self.get_response(request)

    def _refuse(self, request: HttpRequest, limit: int, hint: str) -> HttpResponse:
        sentence = f"This address takes no more than {limit // 1024:,} kB from you. {hint}"
        return refuse(request, 413, "Too much data", sentence, "too_much_data")


def _sender(request: HttpRequest) -> User | None:
    """Return who sends the request, by session or token; None for somebody unknown."""
    if request.user.is_authenticated:
        return request.user
    try:
        identity = TokenAuthentication().authenticate(request)
    except AuthenticationFailed:
        return None
    return identity[0] if identity else None


def _may_send_files(sender: User, allowance: Allowance) -> bool:
    if allowance.world is None or allowance.duty is None:
        return sender.is_superuser
    world = World.objects.visible_to(sender).filter(name=allowance.world).first()
    return world is not None and world.allows(sender, allowance.duty)
