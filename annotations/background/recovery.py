"""Takes work back from workers that stop or are lost."""

from __future__ import annotations

from typing import Any

from django.db import transaction
from django.db.models import QuerySet
from django.utils import timezone

from annotations.background.fencing import Work, fence, held_row
from annotations.background.waking import wake
from annotations.models.background import BackgroundWork, Status, rows_of

MOST_RESUMES = 2


def hand_back(worker: str, model: type[Work]) -> list[Work]:
    """Queue the work of ``worker`` again when it stops in good order, without counting a resumption."""
    return [
        work
        for work in list(rows_of(model).running().filter(worker=worker))
        if _take_back(work, held_row(work), "The worker was stopped", work.resumes)
    ]


def requeue_expired(model: type[Work]) -> list[Work]:
    """Queue work with an expired lease again, or end it as lost. Return the rows that were taken."""
    return [
        work
        for work in list(rows_of(model).expired())
        # Unless its worker has extended the lease in the meantime.
        if _take_back(
            work,
            held_row(work).filter(lease_until=work.lease_until),
            "The worker was lost",
            work.resumes + 1,
        )
    ]


def return_to_queue(work: BackgroundWork, reason: str) -> None:
    """Queue work again that this attempt holds, without counting a resumption. Raises Fenced."""
    if not _take_back(work, held_row(work), reason, work.resumes):
        raise fence(work)


def _take_back(
    work: BackgroundWork, row: QuerySet[BackgroundWork], reason: str, resumes: int
) -> bool:
    """Take the work from its worker if ``row`` still selects it. Return whether it did."""
    values: dict[str, Any]
    if work.cancel_requested:
        message = f"{reason}, after a request to cancel."
        values = {"status": Status.CANCELLED, "finished_at": timezone.now()}
    elif resumes > MOST_RESUMES:
        message = (
            f"Its worker was lost {resumes} times, last {work.worker}. Look in that worker's log and "
            f"in the system's for memory that ran out, then start the {work.noun} again."
        )
        values = {"status": Status.LOST, "failure": message, "finished_at": timezone.now()}
    else:
        message = f"{reason}; {work.resumption}."
        values = {"status": Status.QUEUED, "resumes": resumes}
    with transaction.atomic():
        if not row.update(lease_until=None, worker="", activity="", **values):
            return False
        work.note(message)
    if values["status"] == Status.QUEUED:
        wake(work)
    return True
