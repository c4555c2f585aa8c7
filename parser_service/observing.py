"""What a parser tells while it trains, written to the run's rows and folder."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from parser_service import lifecycle
from parser_service.checkpoints import (
    digest_of,
    remove_folder,
    run_folder,
    stored_folder,
    stored_name,
    write_folder,
)
from parser_service.leasing import Lease
from parser_service.models import Checkpoint
from parser_service.parsers.interface import EpochReport, Observer

PROGRESS_EVERY = 1.0
TRAINING_SHARE = 0.9


def tell_nobody(message: str) -> None:
    """For a run that nobody sits in front of."""


class RunObserver(Observer):
    """Writes epochs, log, progress and checkpoints of the run that ``lease`` holds.

    Training is the first ``TRAINING_SHARE`` of a run's progress, evaluation the rest.
    ``tell`` hears what happens as well. Raises Fenced from everything that writes.
    """

    def __init__(self, lease: Lease, tell: Callable[[str], None] = tell_nobody):
        self.run = lease.run
        self.tell = tell
        self._lease = lease
        self._told = 0.0

    def check(self) -> None:
        self._lease.check()

    def progress(self, fraction: float, message: str = "") -> None:
        self._progress(fraction * TRAINING_SHARE, message)

    def evaluation_progress(self, fraction: float, message: str) -> None:
        """How far the predictions are, from 0 to 1."""
        self._progress(TRAINING_SHARE + fraction * (1 - TRAINING_SHARE), message)

    def _progress(self, fraction: float, message: str) -> None:
        """At most one write a second: a batch may take a millisecond."""
        if time.monotonic() - self._told >= PROGRESS_EVERY:
            self._told = time.monotonic()
            lifecycle.progress(self.run, fraction, message)

    def epoch(self, report: EpochReport) -> None:
        lifecycle.record_epoch(self.run, report)
        accuracy = report.validation_accuracy
        found = "" if accuracy is None else f", {accuracy:.1%} of the validation part right"
        self.tell(f"Epoch {report.epoch}: loss {report.train_loss:.3f}{found}.")

    def log(self, message: str) -> None:
        lifecycle.log(self.run, message)
        self.tell(message)

    def checkpoint(self, epoch: int, is_best: bool, write: Callable[[Path], None]) -> None:
        name = f"epoch-{epoch:04}-attempt-{self.run.attempt}"
        folder = run_folder(self.run.pk) / "checkpoints" / name
        digest = write_folder(folder, write)
        try:
            forgotten = lifecycle.record_checkpoint(
                self.run, epoch, stored_name(folder), digest, is_best
            )
        except lifecycle.Fenced:
            remove_folder(folder)
            raise
        for other in forgotten:
            remove_folder(stored_folder(other))

    def last_checkpoint(self) -> Path | None:
        """The newest checkpoint whose files are the ones that were written."""
        for checkpoint in self.run.checkpoints.order_by("-epoch", "-id"):
            if self._is_sound(checkpoint):
                return stored_folder(checkpoint.folder)
        return None

    def best_checkpoint(self) -> Path | None:
        for checkpoint in self.run.checkpoints.filter(is_best=True).order_by("-epoch"):
            if self._is_sound(checkpoint):
                return stored_folder(checkpoint.folder)
        return None

    def _is_sound(self, checkpoint: Checkpoint) -> bool:
        folder = stored_folder(checkpoint.folder)
        if folder.is_dir() and digest_of(folder) == checkpoint.sha256:
            return True
        self.log(
            f"The checkpoint of epoch {checkpoint.epoch} is missing or altered ({folder}), so it "
            "is not used."
        )
        return False
