"""Carries a job out in a worker: finds its verb, keeps its report, clears away what jobs have left."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Callable
from typing import Any

from django.utils.module_loading import import_string

from annotations import background
from annotations.apps import workbench_apps
from annotations.background.job_files import forget_files
from annotations.background.requesting import refusal_in
from annotations.background.sweeping import sweep
from annotations.background.watching import JobProgress
from annotations.models import Job


def carry_out(job: Job, give_up: Callable[[], None] | None = None) -> None:
    """Bring a claimed job to its end, and clear away what jobs before it have left."""
    background.while_held(job, lambda lease: _do(job, lease), give_up)
    job.refresh_from_db()
    if job.is_ended and not job.is_waiting_for_answer:
        forget_files(job)
    sweep()


def verb_of(kind: str) -> Callable[[Job, JobProgress], dict[str, Any]]:
    """Load the function that carries out jobs of ``kind``. Raises KeyError where no app has one."""
    verbs = ChainMap(*(dict(app.verbs) for app in workbench_apps()))
    return import_string(verbs[kind])  # type: ignore[no-any-return]


def _do(job: Job, lease: background.Lease) -> None:
    progress = JobProgress(job, lease)
    report = verb_of(job.kind)(job, progress)
    if progress.is_concluded:
        return
    if refusal := refusal_in(report):
        background.fail(job, refusal, report=report)
    else:
        background.finish(job, report=report)
