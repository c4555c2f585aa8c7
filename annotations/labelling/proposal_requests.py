"""Ask a worker for what a trained parser answers: to unlabelled utterances, or to a command without a form."""

from __future__ import annotations

from annotations.jobs import request_job, request_job_once
from annotations.models import Job, JobKind, User, World


def request_proposals(world: World, by: User | None = None) -> Job | None:
    """Queue the job, unless one waits already or no utterance is unlabelled; None then."""
    if not world.utterances.unlabelled().exists():
        return None
    waiting = world.jobs.queued().filter(kind=JobKind.PROPOSE).exclude(arguments__has_key="command")
    job, is_new = request_job_once(waiting, JobKind.PROPOSE, world, by)
    return job if is_new else None


def last_request(world: World, command: str, run: int) -> Job | None:
    """Return the newest job that asked the parser of ``run`` about an anonymized command."""
    asked = world.jobs.filter(kind=JobKind.PROPOSE, arguments__command=command, arguments__run=run)
    return asked.order_by("-pk").first()


def request_answer(world: World, command: str, run: int, by: User) -> Job:
    """Queue the job that asks the parser of ``run`` about an anonymized command."""
    return request_job(JobKind.PROPOSE, world.name, by, {"command": command, "run": run})
