"""The names under which only this computer is reached."""

from __future__ import annotations

from ipaddress import ip_address
from urllib.parse import urlsplit

from django.conf import settings


def is_local_site() -> bool:
    """Return whether the site answers only under names of this computer."""
    return set(settings.ALLOWED_HOSTS) <= set(settings.LOCAL_HOSTS)


def is_local_link(link: str) -> bool:
    """Return whether only this computer opens ``link``."""
    return is_local_name(urlsplit(link).hostname or "")


def is_local_name(name: str) -> bool:
    """Return whether a name, or an address, is this computer wherever it is looked up."""
    name = name.lower().rstrip(".")
    if name == "localhost" or name.endswith(".localhost"):
        return True
    return is_address(name) and (ip_address(name).is_loopback or ip_address(name).is_unspecified)


def is_address(name: str) -> bool:
    """Return whether a name is an IP address."""
    try:
        ip_address(name)
    except ValueError:
        return False
    return True
