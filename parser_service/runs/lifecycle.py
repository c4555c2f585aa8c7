"""The one writer of a run's status, epochs and checkpoints. (What a run begins with is in ``requesting``.)

What runs share with other background work is in ``annotations.background``: this module adds what only
training has.
"""

from __future__ import annotations

from annotations import background
from annotations.background import (  # noqa: F401  # offered here too
    LEASE,
    MOST_RESUMES,
    Fenced,
    acknowledge_cancel,
    cancel,
    extend,
    fail,
    held,
    is_cancel_requested,
    log,
    record_progress,
)
from parser_service.models import Checkpoint, EpochMetric, TrainingRun
from parser_service.parsers.interface import EpochReport


def claim(worker: str, queue: str, run: TrainingRun | None = None) -> TrainingRun | None:
    """Claim the oldest queued run of ``queue`` (or ``run``) for ``worker``. Return None if there is none."""
    return background.claim(worker, queue, TrainingRun, run)


@background.outlasting
def record_epoch(run: TrainingRun, report: EpochReport) -> None:
    """Record an epoch; one that is trained again after a resumption replaces its row. Raises Fenced."""
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


@background.outlasting
def record_checkpoint(
    run: TrainingRun, epoch: int, folder: str, sha256: str, is_best: bool
) -> list[str]:
    """Record a checkpoint and forget all but the last and the best. Raises Fenced.

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


def finish(run: TrainingRun, parameters: int, seconds: float) -> None:
    """End the run as succeeded. ``seconds`` is the training time. Raises Fenced."""
    background.finish(run, parameters=parameters, seconds_trained=seconds)


def hand_back(worker: str) -> list[TrainingRun]:
    """Queue the runs of ``worker`` again when it stops in good order, without counting a resumption."""
    return background.hand_back(worker, TrainingRun)


def requeue_expired() -> list[TrainingRun]:
    """Queue runs with an expired lease again, or end them as lost. Return the runs that were taken."""
    return background.requeue_expired(TrainingRun)
