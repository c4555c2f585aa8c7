"""Asks a worker for what the best parser answers to unlabelled utterances."""

from __future__ import annotations

from annotations.jobs import request_job
from annotations.models import Job, JobKind, User, World


def request_proposals(world: World, by: User | None = None) -> Job | None:
    """Queue the job, unless one waits already or no utterance is unlabelled; None then."""
    waiting = world.jobs.queued().filter(kind=JobKind.PROPOSE)
    if waiting.exists() or not world.utterances.unlabelled().exists():
        return None
    return request_job(JobKind.PROPOSE, world.name, by)
