"""Which addresses a campaign may name: where people go back to, and whose pages may frame it."""

from __future__ import annotations

import re
from http import HTTPStatus
from urllib.parse import urlsplit

from annotations.language.texts import Refusal
from annotations.people.local_names import is_address, is_local_name, is_local_site

MOST_ORIGINS = 5
# Names that only a network of its own knows.
_PRIVATE = ("local", "localhost", "internal", "intranet", "lan", "home", "corp", "private", "arpa")
_NAME = re.compile(
    r"(?=.{1,253}\Z)([a-z0-9]([a-z0-9-]{0,61}[a-z0-9])?\.)+(xn--[a-z0-9-]+|[a-z]{2,63})"
)


class BadAddress(Refusal):
    """Nobody may be sent to an address, or framed by it."""

    code = "bad_address"
    status = HTTPStatus.UNPROCESSABLE_ENTITY


def require_public_address(address: str) -> None:
    """Refuse an address that is not ``https://`` and a name that everybody knows.

    Where the site itself is served to this computer alone, ``http://localhost`` is taken, too: to try it out.

    Raises:
        BadAddress: it has another scheme, a user name, or the name of a machine that only some can reach.
    """
    try:
        parts = urlsplit(address)
        name, _ = (parts.hostname or "").rstrip("."), parts.port
        name = name.encode("idna").decode() if not name.isascii() else name
    except ValueError:
        raise BadAddress("Write a whole address, such as https://market.example/back.") from None
    if "@" in parts.netloc or "\\" in address:
        raise BadAddress("Leave out the user name and the password: everybody would see them.")
    if is_local_name(name) and parts.scheme == "http" and is_local_site():
        return
    if parts.scheme != "https":
        raise BadAddress("Begin the address with https://.")
    if is_address(name) or name.rpartition(".")[2] in _PRIVATE or not _NAME.fullmatch(name):
        raise BadAddress("Name a site that everybody can reach, such as https://market.example/.")


def origins_in(text: str) -> str:
    """Return the origins that stand in ``text``, each once, separated by one blank.

    Raises:
        BadAddress: they are too many, or one is no origin of a public site.
    """
    origins = list(dict.fromkeys(text.replace(",", " ").lower().split()))
    if len(origins) > MOST_ORIGINS:
        raise BadAddress(f"Name at most {MOST_ORIGINS} sites.")
    for position, origin in enumerate(origins):
        require_public_address(origin)
        parts = urlsplit(origin)
        if parts.path.strip("/") or parts.query or parts.fragment or not parts.netloc.isascii():
            raise BadAddress(f"Write only the beginning of {origin}: https:// and the name.")
        if re.search(r"[^a-z0-9.:\[\]-]", parts.netloc):
            raise BadAddress("Separate the sites by blanks.")
        origins[position] = f"{parts.scheme}://{parts.netloc}"
    return " ".join(dict.fromkeys(origins))


def origin_of(address: str) -> str:
    """Return scheme and name of an address."""
    parts = urlsplit(address)
    return f"{parts.scheme}://{parts.netloc}"
