"""Who a contributor is, without a name: a keyed hash of a device or of a crowd market's id."""

from __future__ import annotations

import secrets
from collections.abc import Mapping

from django.utils.crypto import salted_hmac

from annotations.models import Campaign

DEVICE = "device"
# The names under which crowd markets send who somebody is, in the address of the page.
MARKET_IDS = ("PROLIFIC_PID", "workerId")
LONGEST_MARKET_ID = 100
_DIGITS = 24  # hexadecimal ones: 96 bits


def pseudonym_of(campaign: Campaign, source: str, identity: str) -> str:
    """Return 24 hexadecimal digits: HMAC-SHA-256 with the site's key, another one in each campaign.

    Nobody gets the identity back without the key, and nobody can tell that two campaigns had the same person.
    """
    salt = f"annotations.campaigns.{campaign.pk}"
    return salted_hmac(salt, f"{source}:{identity}", algorithm="sha256").hexdigest()[:_DIGITS]


def new_device() -> str:
    """Return what a browser keeps to be known again: 128 random bits."""
    return secrets.token_hex(16)


def market_id_in(query: Mapping[str, str]) -> tuple[str, str] | None:
    """Return the name and the value of the market's id in an address; None without a usable one."""
    for name in MARKET_IDS:
        value = query.get(name, "").strip()
        if value and len(value) <= LONGEST_MARKET_ID and value.isprintable():
            return name, value
    return None
