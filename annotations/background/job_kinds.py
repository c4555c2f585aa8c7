"""What carries out each kind of job, by dotted path: app configs register it, so that no job loads the
verb of another one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.utils.module_loading import import_string

from annotations.background.watching import JobProgress
from annotations.models import Job, JobKind

# Takes a claimed job and its progress, and returns the report.
Verb = Callable[[Job, JobProgress], dict[str, Any]]

_VERBS: dict[JobKind, str] = {}
_SWEEPS: list[str] = []


def register_verb(kind: JobKind, dotted: str) -> None:
    """Let the ``Verb`` at ``dotted`` carry out jobs of ``kind``. It is loaded in a worker's child only."""
    _VERBS[kind] = dotted


def register_sweep(dotted: str) -> None:
    """Call the function at ``dotted`` after each job: it clears away what interrupted jobs have left."""
    if dotted not in _SWEEPS:
        _SWEEPS.append(dotted)


def verb_of(kind: JobKind) -> Verb:
    verb: Verb = import_string(_VERBS[kind])
    return verb


def sweeps() -> list[Callable[[], None]]:
    return [import_string(dotted) for dotted in _SWEEPS]
