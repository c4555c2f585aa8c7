"""Where a request comes from: the address behind the proxies that the settings name."""

from __future__ import annotations

from collections.abc import Callable
from ipaddress import ip_address

from django.conf import settings
from django.http import HttpRequest, HttpResponse

# What only a trusted proxy may say of the request that it hands on.
FORWARDED = (
    "HTTP_FORWARDED",
    "HTTP_X_FORWARDED_FOR",
    "HTTP_X_FORWARDED_HOST",
    "HTTP_X_FORWARDED_PORT",
    "HTTP_X_FORWARDED_PROTO",
)


class ClientAddress:
    """Middleware: set ``REMOTE_ADDR`` to the client's address, and drop headers that no trusted proxy has
    sent."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        peer = str(request.META.get("REMOTE_ADDR", ""))
        if is_trusted(peer):
            forwarded = str(request.META.get("HTTP_X_FORWARDED_FOR", ""))
            request.META["REMOTE_ADDR"] = client_address(peer, forwarded)
        else:
            for header in FORWARDED:
                request.META.pop(header, None)
        return self.get_response(request)


def client_address(peer: str, forwarded: str) -> str:
    """Return the nearest address in ``X-Forwarded-For`` that does not belong to a trusted proxy. Proxies
    append, so the list is read from its end. Everything before an untrusted address, or before something
    unreadable, may be made up.
    """
    address = peer
    for entry in reversed(forwarded.split(",")):
        if not _is_address(entry.strip()):
            return address
        address = entry.strip()
        if not is_trusted(address):
            return address
    return address


def is_trusted(address: str) -> bool:
    return _is_address(address) and any(
        ip_address(address) in network for network in settings.TRUSTED_PROXIES
    )


def _is_address(text: str) -> bool:
    try:
        ip_address(text)
    except ValueError:
        return False
    return True
