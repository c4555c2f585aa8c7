"""Numbers with their nouns, as the pages around both apps say them."""

from __future__ import annotations


def say_count(count: int, noun: str, plural: str = "") -> str:
    """Return ``1 draft`` or ``4 drafts``, empty for none. ``plural`` is for nouns that take more than an s."""
    if not count:
        return ""
    return f"{count:,} {noun if count == 1 else plural or noun + 's'}"
