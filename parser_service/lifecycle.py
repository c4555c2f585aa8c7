"""The one writer of a run's status: queued → running → succeeded, failed, cancelled or lost. (What a
run begins with is in ``requesting``.)

The row of a run is the truth. Whoever claims a run raises its ``attempt``; every later write carries
that number as a fencing token and is refused when it is stale, so that a worker which comes back
after its lease was lost changes nothing. A message only wakes a worker up, and may be lost.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import timedelta
from typing import Any

from django.conf import settings
from django.db import transaction
from django.db.models import QuerySet
from django.utils import timezone

from parser_service.models import Checkpoint, EpochMetric, RunEvent, TrainingRun
from parser_service.models.runs import Status
from parser_service.parsers.interface import EpochReport
from parser_service.waking import wake

LEASE = timedelta(seconds=45 / settings.WORK_TEMPO)
MOST_RESUMES = 2


class Fenced(Exception):
    """A write was refused: the run is no longer this attempt's."""


# --- holding a run --------------------------------------------------------------------------------


def claim(worker: str, queue: str, run: TrainingRun | None = None) -> TrainingRun | None:
    """The oldest queued run of ``queue`` (or ``run``), now running for ``worker``; None if there is none.

    Of several who try for one run, the conditional update lets one win.
    """
    while waiting := _waiting(queue, run).order_by("queued_at", "id").first():
        won = _waiting(queue, waiting).filter(attempt=waiting.attempt)
        now = timezone.now()
        if won.update(
            status=Status.RUNNING,
            attempt=waiting.attempt + 1,
            worker=worker,
            lease_until=now + LEASE,
            started_at=waiting.started_at or now,
            activity="starting",
        ):
            waiting.refresh_from_db()
            log(waiting, f"Attempt {waiting.attempt} begins on {worker}.")
            return waiting
    return None


def _waiting(queue: str, run: TrainingRun | None) -> QuerySet[TrainingRun]:
    waiting = TrainingRun.objects.queued().filter(queue=queue)
    return waiting.filter(pk=run.pk) if run else waiting


def _ours(run: TrainingRun) -> QuerySet[TrainingRun]:
    """The run's row while this attempt holds it; no row otherwise."""
    return TrainingRun.objects.running().filter(pk=run.pk, attempt=run.attempt)


def _fence(run: TrainingRun) -> Fenced:
    return Fenced(f"Run {run.pk} no longer belongs to attempt {run.attempt} of {run.worker}.")


def _write(run: TrainingRun, **values: Any) -> None:
    if not _ours(run).update(**values):
        raise _fence(run)


@contextmanager
def held(run: TrainingRun) -> Iterator[None]:
    """A transaction in which the run stays ours. Raises Fenced, before anything is written, if it is not."""
    with transaction.atomic():
        if _ours(run).select_for_update().values_list("pk").first() is None:
            raise _fence(run)
        yield


def extend(run: TrainingRun) -> None:
    """Puts the end of the lease off. Raises Fenced."""
    _write(run, lease_until=timezone.now() + LEASE)


def is_cancel_requested(run: TrainingRun) -> bool:
    """Whether somebody asked for the run to stop. Raises Fenced."""
    found = _ours(run).values_list("cancel_requested", flat=True).first()
    if found is None:
        raise _fence(run)
    return found


def progress(run: TrainingRun, fraction: float, activity: str) -> None:
    """Records how far the run is, 0 to 1, and what it does. Raises Fenced."""
    _write(run, progress=min(max(fraction, 0.0), 1.0), activity=activity[:200])


def log(run: TrainingRun, message: str) -> None:
    """Adds a line to the run's log. Raises Fenced."""
    with held(run):
        _add_event(run, message)


def _add_event(run: TrainingRun, message: str) -> None:
    RunEvent.objects.create(run=run, attempt=run.attempt, message=message)


def record_epoch(run: TrainingRun, report: EpochReport) -> None:
    """Records an epoch; one that is trained again after a resumption replaces its row. Raises Fenced."""
    with held(run):
        EpochMetric.objects.filter(run=run, epoch__gte=report.epoch).delete()
        EpochMetric.objects.create(
            run=run,
            epoch=report.epoch,
            train_loss=report.train_loss,
            validation_loss=report.validation_loss,
            validation_accuracy=report.validation_accuracy,
            seconds=report.seconds,
        )


def record_checkpoint(
    run: TrainingRun, epoch: int, folder: str, sha256: str, is_best: bool
) -> list[str]:
    """Records a checkpoint and forgets all but the last and the best. Raises Fenced.

    Returns the folders that nothing refers to any more.
    """
    with held(run):
        earlier = Checkpoint.objects.filter(run=run)
        superseded = earlier.exclude(is_best=True) if not is_best else earlier
        superseded = superseded | earlier.filter(epoch__gte=epoch)
        forgotten = list(superseded.values_list("folder", flat=True))
        superseded.delete()
        Checkpoint.objects.create(
            run=run, epoch=epoch, folder=folder, sha256=sha256, is_best=is_best
        )
    return [name for name in forgotten if name != folder]


# --- ending a run ---------------------------------------------------------------------------------


def finish(run: TrainingRun, parameters: int, seconds: float) -> None:
    """The run has succeeded. Raises Fenced."""
    with held(run):
        _write(run, parameters=parameters, seconds_trained=seconds, progress=1.0)
        _end(run, Status.SUCCEEDED, "Finished.")


def fail(run: TrainingRun, failure: str) -> None:
    """The run cannot succeed; ``failure`` is a sentence with what to do. Raises Fenced."""
    with held(run):
        _write(run, failure=failure)
        _end(run, Status.FAILED, failure)


def acknowledge_cancel(run: TrainingRun) -> None:
    """The run has stopped as it was asked to. Raises Fenced."""
    with held(run):
        _end(run, Status.CANCELLED, "Cancelled while it ran.")


def _end(run: TrainingRun, status: Status, message: str) -> None:
    _add_event(run, message)
    _write(run, status=status, finished_at=timezone.now(), lease_until=None, activity="")


def cancel(run: TrainingRun) -> None:
    """Stops a run: at once while it waits, within seconds while it runs.

    Raises ValueError, a sentence, where it has already ended.
    """
    while True:
        now = timezone.now()
        row = TrainingRun.objects.filter(pk=run.pk)
        ended = {"status": Status.CANCELLED, "finished_at": now, "cancel_requested": True}
        if row.filter(status=Status.QUEUED).update(**ended):
            return _note(run.pk, "Cancelled while it waited.")
        if row.filter(status=Status.RUNNING, lease_until__lt=now).update(**ended):
            return _note(run.pk, "Cancelled after its worker was lost.")
        if row.filter(status=Status.RUNNING).update(cancel_requested=True):
            return _note(run.pk, "Asked to stop.")
        run.refresh_from_db()
        if run.is_ended:
            raise ValueError(f"Run {run.pk} has already ended: {run.status}.")


def _note(pk: int, message: str) -> None:
    """A line in the log of a run that this process does not hold."""
    _add_event(TrainingRun.objects.get(pk=pk), message)


# --- taking runs back from workers -----------------------------------------------------------------


def hand_back(worker: str) -> list[TrainingRun]:
    """Queues what ``worker`` runs, because it stops in good order; this counts as no resumption."""
    runs = list(TrainingRun.objects.running().filter(worker=worker))
    return [
        run for run in runs if _take_back(run, _ours(run), "The worker was stopped", run.resumes)
    ]


def requeue_expired() -> list[TrainingRun]:
    """Queues again, or gives up as lost, what no living worker extends; the runs that were taken."""
    return [
        run
        for run in list(TrainingRun.objects.expired())
        # Unless its worker has extended the lease in the meantime.
        if _take_back(
            run,
            _ours(run).filter(lease_until=run.lease_until),
            "The worker was lost",
            run.resumes + 1,
        )
    ]


def _take_back(run: TrainingRun, row: QuerySet[TrainingRun], reason: str, resumes: int) -> bool:
    """Takes a run from its worker where ``row`` still finds it; whether it did."""
    values, message = _after_interruption(run, reason, resumes)
    with transaction.atomic():
        if not row.update(lease_until=None, worker="", activity="", **values):
            return False
        _add_event(run, message)
    if values["status"] == Status.QUEUED:
        wake(run)
    return True


def _after_interruption(run: TrainingRun, reason: str, resumes: int) -> tuple[dict[str, Any], str]:
    """What becomes of an interrupted run: the values to store and a line for its log."""
    ended = {"finished_at": timezone.now()}
    if run.cancel_requested:
        return {"status": Status.CANCELLED, **ended}, f"{reason}; the run was to be cancelled."
    if resumes > MOST_RESUMES:
        failure = (
            f"Its worker was lost {resumes} times, last {run.worker}. Look in that worker's log and "
            "in the system's for memory that ran out, then start the run again."
        )
        return {"status": Status.LOST, "failure": failure, **ended}, failure
    message = f"{reason}; the run goes on from its last checkpoint."
    return {"status": Status.QUEUED, "resumes": resumes}, message
