"""Ask a worker for what a trained parser answers: to unlabelled utterances and to what contributors wrote, or to a
command without a form."""

from __future__ import annotations

from annotations.apps import workbench_apps
from annotations.background.requesting import request_job, request_job_once
from annotations.models import Job, JobKind, Submission, User, World


def request_proposals(world: World, by: User | None = None) -> Job | None:
    """Queue the job, unless one waits already, or no utterance is unlabelled and no submission waits; None then."""
    submitted = Submission.objects.filter(contributor__campaign__world=world)
    if not world.utterances.unlabelled().exists() and not submitted.awaiting_moderation().exists():
        return None
    waiting = world.jobs.queued().filter(kind=JobKind.PROPOSE).exclude(arguments__has_key="command")
    job, is_new = request_job_once(waiting, JobKind.PROPOSE, world, by)
    return job if is_new else None


def request_readings(world: World) -> Job | None:
    """Queue the job once somebody has submitted or decided something, unless one waits or no parser could answer; None
    then."""
    has_one = any(app.has_parser(world) for app in workbench_apps())
    return request_proposals(world) if has_one else None


def last_request(world: World, command: str, run: int) -> Job | None:
    """Return the newest job that asked the parser of ``run`` about an anonymized command."""
    asked = world.jobs.filter(kind=JobKind.PROPOSE, arguments__command=command, arguments__run=run)
    return asked.order_by("-pk").first()


def request_answer(world: World, command: str, run: int, by: User) -> Job:
    """Queue the job that asks the parser of ``run`` about an anonymized command."""
    return request_job(JobKind.PROPOSE, world.name, by, {"command": command, "run": run})
