"""Asks a worker to analyse the errors of a run, or to measure what its world answers with it."""

from __future__ import annotations

from annotations.background.requesting import request_job_once
from annotations.models import Job, JobKind, User
from annotations.models.background import JobQuerySet
from parser_service.models import TrainingRun

MOST_MEASURED = 20_000  # examples; a minute or two for most parsers


def analysis_jobs(run: TrainingRun) -> JobQuerySet:
    """Return the jobs that analyse ``run``, the newest first."""
    return run.world.jobs.filter(kind=JobKind.ANALYSE, arguments__run=run.pk).order_by("-pk")


def request_analysis(run: TrainingRun, by: User | None = None, again: bool = False) -> Job:
    """Queue the job where the run was trained, unless one waits or works already; return it.

    What an earlier job has found is kept, so that this one goes on where that stopped. With ``again`` it
    makes anew what depends on the world of today: the plans of answers and the proposals of error categories.
    """
    arguments = {"run": run.pk, "again": True} if again else {"run": run.pk}
    active = analysis_jobs(run).active()
    return request_job_once(active, JobKind.ANALYSE, run.world, by, arguments, run.queue)[0]


def request_measurement_with(run: TrainingRun, by: User | None = None) -> Job | None:
    """Queue the measurement of what the world of a promoted run answers, on the split of the run, unless one waits
    already; return it. It calibrates how sure the answers are.

    A split with more than ``MOST_MEASURED`` examples is measured only where a person asks for it: None.
    """
    if run.split.examples.count() > MOST_MEASURED:
        return None
    waiting = run.world.jobs.queued().filter(kind=JobKind.MEASURE)
    arguments = {"split": run.split_id}
    return request_job_once(waiting, JobKind.MEASURE, run.world, by, arguments, run.queue)[0]
