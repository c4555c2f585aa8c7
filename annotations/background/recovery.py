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
    values, message = _after_interruption(work, reason, resumes)
    with transaction.atomic():
        if not row.update(lease_until=None, worker="", activity="", **values):
            return False
        work.note(message)
    if values["status"] == Status.QUEUED:
        wake(work)
    return True


def _after_interruption(
    work: BackgroundWork, reason: str, resumes: int
) -> tuple[dict[str, Any], str]:
    """Return the values to store for interrupted work and a line for its log."""
    ended = {"finished_at": timezone.now()}
    if work.cancel_requested:
        return {"status": Status.CANCELLED, **ended}, f"{reason}, after a request to cancel."
    if resumes > MOST_RESUMES:
        failure = (
            f"Its worker was lost {resumes} times, last {work.worker}. Look in that worker's log and "
            f"in the system's for memory that ran out, then start the {work.noun} again."
        )
        return {"status": Status.LOST, "failure": failure, **ended}, failure
    return {"status": Status.QUEUED, "resumes": resumes}, f"{reason}; {work.resumption}."
