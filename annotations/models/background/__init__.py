"""What workers carry out."""

from __future__ import annotations

from annotations.models.background.jobs import Job, JobKind, JobQuerySet, job_kind_choices
from annotations.models.background.work import (
    LEASE,
    BackgroundWork,
    Queue,
    Status,
    WorkQuerySet,
    queue_choices,
    status_choices,
)

__all__ = [
    "LEASE",
    "BackgroundWork",
    "Job",
    "JobKind",
    "JobQuerySet",
    "Queue",
    "Status",
    "WorkQuerySet",
    "job_kind_choices",
    "queue_choices",
    "status_choices",
]
