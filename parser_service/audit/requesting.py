"""Verb: let a worker look for labels that may be wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from annotations.jobs import request_job
from annotations.models import Job, JobKind, User, World


def request_audit(world: World, by: User, choice: Mapping[str, Any]) -> Job:
    """Return the audit of ``world`` that waits or runs, or ask for one with ``choice``.

    Args:
        choice: ``parser``, ``folds`` and ``to_queue``, as the form of the page has them.
    """
    job = world.jobs.active().filter(kind=JobKind.AUDIT).first()
    return job or request_job(JobKind.AUDIT, world.name, by, choice)
