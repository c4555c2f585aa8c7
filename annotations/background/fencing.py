"""The writes to a piece of work: queued → running → succeeded, failed or cancelled.

The row is the truth. Whoever claims it raises its ``attempt``; every later write carries that number
as a fencing token and is refused when it is stale, so that a worker which comes back after its lease
was lost changes nothing. A message only wakes a worker up, and may be lost. Leases are set and compared
by the database's clock, which all machines share.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from http import HTTPStatus
from typing import Any, TypeVar

from django.db import transaction
from django.db.models import QuerySet
from django.db.models.functions import Now
from django.utils import timezone

from annotations.background.outages import outlasting
from annotations.language.texts import Refusal
from annotations.models.background import LEASE, BackgroundWork, Status, rows_of

Work = TypeVar("Work", bound=BackgroundWork)


class Fenced(Exception):
    """A write was refused: the work is no longer this attempt's."""


def claim(
    worker: str, queue: str, model: type[Work], work: BackgroundWork | None = None
) -> Work | None:
    """Claim the oldest queued row of ``queue`` (or ``work``) for ``worker``. Return None if there is none.

    Where several try to claim one row, the conditional update lets one win.
    """
    while waiting := _waiting(queue, model, work).order_by("queued_at", "id").first():
        won = _waiting(queue, model, waiting).filter(attempt=waiting.attempt)
        now = timezone.now()
        if won.update(
            status=Status.RUNNING,
            attempt=waiting.attempt + 1,
            worker=worker,
            lease_until=Now() + LEASE,
            started_at=waiting.started_at or now,
            activity="starting",
        ):
            waiting.refresh_from_db()
            log(waiting, f"Attempt {waiting.attempt} begins on {worker}.")
            return waiting
    return None


def _waiting(queue: str, model: type[Work], work: BackgroundWork | None) -> QuerySet[Work]:
    waiting = rows_of(model).queued().filter(queue=queue)
    return waiting.filter(pk=work.pk) if work else waiting


def held_row(work: Work) -> QuerySet[Work]:
    """Return the row of ``work`` while this attempt holds it; no row otherwise."""
    return rows_of(type(work)).running().filter(pk=work.pk, attempt=work.attempt)


def fence(work: BackgroundWork) -> Fenced:
    """Make the error of a write to work that this attempt no longer holds."""
    name = f"{work.noun.capitalize()} {work.pk}"
    return Fenced(f"{name} no longer belongs to attempt {work.attempt} of {work.worker}.")


def write(work: BackgroundWork, **values: Any) -> None:
    """Write columns of the row that this attempt holds. Raises Fenced."""
    if not held_row(work).update(**values):
        raise fence(work)


@contextmanager
def held(work: BackgroundWork) -> Iterator[None]:
    """Open a transaction in which this attempt keeps the work. Raises Fenced before anything is written."""
    with transaction.atomic():
        if held_row(work).select_for_update().values_list("pk").first() is None:
            raise fence(work)
        yield


def extend(work: BackgroundWork) -> None:
    """Extend the lease. Raises Fenced."""
    write(work, lease_until=Now() + LEASE)


def is_cancel_requested(work: BackgroundWork) -> bool:
    """Tell whether somebody asked for the work to stop. Raises Fenced."""
    requested = held_row(work).values_list("cancel_requested", flat=True).first()
    if requested is None:
        raise fence(work)
    return requested


@outlasting
def record_progress(work: BackgroundWork, fraction: float, activity: str) -> None:
    """Record how far the work is, 0 to 1, and what it does now. Raises Fenced."""
    write(work, progress=min(max(fraction, 0.0), 1.0), activity=activity)


@outlasting
def log(work: BackgroundWork, message: str) -> None:
    """Add a line to the work's log. Raises Fenced."""
    with held(work):
        work.note(message)


@outlasting
def finish(work: BackgroundWork, **values: Any) -> None:
    """End the work as succeeded and write ``values``, columns of its kind. Raises Fenced."""
    with held(work):
        write(work, progress=1.0, **values)
        _end(work, Status.SUCCEEDED, "Finished.")


@outlasting
def fail(work: BackgroundWork, failure: str, **values: Any) -> None:
    """End the work as failed; ``failure`` is a sentence that says what to do. Raises Fenced."""
    with held(work):
        write(work, failure=failure, **values)
        _end(work, Status.FAILED, failure)


@outlasting
def acknowledge_cancel(work: BackgroundWork) -> None:
    """End the work as cancelled, once it has stopped. Raises Fenced."""
    with held(work):
        _end(work, Status.CANCELLED, "Cancelled while it ran.")


def _end(work: BackgroundWork, status: Status, message: str) -> None:
    work.note(message)
    # Before the row has it: its lease, in another thread, then knows that nobody else has ended it.
    work.status = status
    write(work, status=status, finished_at=timezone.now(), lease_until=None, activity="")


def cancel(work: BackgroundWork) -> None:
    """Cancel the work: at once while it waits, within seconds while it runs.

    Raises Refusal where it has already ended.
    """
    row = type(work).objects.filter(pk=work.pk)
    while True:
        now = timezone.now()
        ended = {"status": Status.CANCELLED, "finished_at": now, "cancel_requested": True}
        if row.filter(status=Status.QUEUED).update(**ended):
            return row.get().note("Cancelled while it waited.")
        if row.filter(status=Status.RUNNING, lease_until__lt=Now()).update(**ended):
            return row.get().note("Cancelled after its worker was lost.")
        if row.filter(status=Status.RUNNING).update(cancel_requested=True):
            return row.get().note("Asked to stop.")
        work.refresh_from_db()
        if work.is_ended:
            name = f"{work.noun.capitalize()} {work.pk}"
            sentence = f"{name} has already ended: {work.status}."
            raise Refusal(sentence, "already_ended", HTTPStatus.CONFLICT)
