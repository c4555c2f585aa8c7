"""Rows of other applications that belong to a world. App configs register them."""

from __future__ import annotations

_REGISTERED: list[str] = []


def register_part(dotted: str) -> None:
    """Let archives of worlds hold the ``world_archive.Table`` at ``dotted``, which is loaded when one is
    written or read."""
    if dotted not in _REGISTERED:
        _REGISTERED.append(dotted)


def registered_parts() -> tuple[str, ...]:
    return tuple(_REGISTERED)
