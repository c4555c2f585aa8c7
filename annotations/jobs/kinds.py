"""The verbs of other applications that jobs carry out. App configs register them."""

from __future__ import annotations

from annotations.models.background import JobKind

_REGISTERED: dict[JobKind, str] = {}


def register_verb(kind: JobKind, dotted: str) -> None:
    """Let the function at ``dotted`` carry out jobs of ``kind``: it takes a job and its progress, and
    returns the report. It is loaded in a worker's child only."""
    _REGISTERED[kind] = dotted


def registered_verb(kind: JobKind) -> str:
    return _REGISTERED[kind]
