"""Who a contributor is, without a name: a keyed hash of a device or of a crowd market's id."""

from __future__ import annotations

import re
import secrets
from collections.abc import Mapping
from urllib.parse import unquote

from django.utils.crypto import salted_hmac

from annotations.models import Campaign

DEVICE = "device"
# The names under which crowd markets send who somebody is, and for which assignment, in the address of the page.
MARKET_IDS = ("PROLIFIC_PID", "workerId")
ASSIGNMENT_IDS = ("assignmentId", "SESSION_ID")
NOT_ACCEPTED = "ASSIGNMENT_ID_NOT_AVAILABLE"  # what Mechanical Turk sends to who only looks
LONGEST_ASSIGNMENT = 200
_DIGITS = 24  # hexadecimal ones: 96 bits
# A placeholder that nobody filled in: signs that no id has, or the same two signs before and behind a word.
_PLACEHOLDER = re.compile(r"[{}\[\]()<>%$\ufffd]|\A([^A-Za-z0-9])\1.*\1\1\Z", re.DOTALL)
_NOBODY = {"null", "undefined", "none", "nan"}


def pseudonym_of(campaign: Campaign, source: str, identity: str) -> str:
    """Return 24 hexadecimal digits: HMAC-SHA-256 with the site's key, another one in each campaign.

    Nobody gets the identity back without the key, and nobody can tell that two campaigns had the same person.
    """
    salt = f"annotations.campaigns.{campaign.pk}"
    return salted_hmac(salt, f"{source}:{identity}", algorithm="sha256").hexdigest()[:_DIGITS]


def new_device() -> str:
    """Return what a browser keeps to be known again: 128 random bits."""
    return secrets.token_hex(16)


def market_id_in(campaign: Campaign, query: Mapping[str, str]) -> tuple[str, str] | None:
    """Return the name and the value of the market's id in an address; None without a usable one."""
    return _filled_in(query, campaign.worker_parameter, MARKET_IDS)


def assignment_in(campaign: Campaign, query: Mapping[str, str]) -> str:
    """Return the market's id of what somebody does in an address; empty without a usable one."""
    sent = _filled_in(query, campaign.assignment_parameter, ASSIGNMENT_IDS)
    return sent[1] if sent and len(sent[1]) <= LONGEST_ASSIGNMENT else ""


def _filled_in(
    query: Mapping[str, str], chosen: str, known: tuple[str, ...]
) -> tuple[str, str] | None:
    """Return the first parameter that the market has filled in; only ``chosen``, if the campaign names one."""
    for name in (chosen,) if chosen else known:
        value = query.get(name, "").strip()
        if value and value.isprintable() and not _is_placeholder(name, value):
            return name, value
    return None


def _is_placeholder(name: str, value: str) -> bool:
    word = unquote(value)
    return bool(_PLACEHOLDER.search(word)) or word.casefold() in {name.casefold(), *_NOBODY}
