"""Writes what a parser reports while it trains to the run's rows and folder."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from annotations.background import DatabaseAway, Fenced, Lease, Stopped
from parser_service.models import TrainingRun
from parser_service.parsers.interface import Cancelled, EpochReport, Observer
from parser_service.runs import lifecycle
from parser_service.runs.checkpoints import (
    digest_of,
    remove_folder,
    run_folder,
    stored_folder,
    stored_name,
    write_folder,
)

PROGRESS_EVERY = 1.0
CHECKPOINT_EVERY = 20.0  # seconds, or longer where writing one takes more than a tenth of them
WRITING_SHARE = 0.1
TRAINING_SHARE = 0.9


def tell_nobody(message: str) -> None:
    """Ignore ``message``: nobody watches a run in the background."""


class RunObserver(Observer):
    """Writes epochs, log, progress and checkpoints of the run that ``lease`` holds.

    Training is the first ``TRAINING_SHARE`` of a run's progress, evaluation the rest.
    ``tell`` hears what happens as well. Raises Fenced from everything that writes.
    """

    def __init__(self, lease: Lease, tell: Callable[[str], None] = tell_nobody):
        assert isinstance(lease.work, TrainingRun)
        self.run = lease.work
        self.tell = tell
        self._lease = lease
        self._told = 0.0
        self._checkpoints = 0
        self._kept = time.monotonic()  # when the last one was written
        self._writing = 0.0  # the seconds that it took

    def check(self) -> None:
        try:
            self._lease.check()
        except Stopped as error:
            raise Cancelled(str(error)) from None

    def progress(self, fraction: float, message: str = "") -> None:
        self._progress(fraction * TRAINING_SHARE, message)

    def evaluation_progress(self, fraction: float, message: str) -> None:
        """Record how far the predictions are, from 0 to 1."""
        self._progress(TRAINING_SHARE + fraction * (1 - TRAINING_SHARE), message)

    def _progress(self, fraction: float, message: str) -> None:
        """Write at most once a second: a batch may take a millisecond."""
        if time.monotonic() - self._told >= PROGRESS_EVERY:
            self._told = time.monotonic()
            lifecycle.record_progress(self.run, fraction, message)

    def epoch(self, report: EpochReport) -> None:
        lifecycle.record_epoch(self.run, report)
        accuracy = report.validation_accuracy
        right = "" if accuracy is None else f", {accuracy:.1%} of the validation part right"
        self.tell(f"Epoch {report.epoch}: loss {report.train_loss:.3f}{right}.")

    def log(self, message: str) -> None:
        lifecycle.log(self.run, message)
        self.tell(message)

    def is_checkpoint_due(self) -> bool:
        every = max(CHECKPOINT_EVERY, self._writing / WRITING_SHARE)
        return time.monotonic() - self._kept >= every

    def checkpoint(self, epoch: int, is_best: bool, write: Callable[[Path], None]) -> None:
        began = time.monotonic()
        self._checkpoints += 1
        # There may be several of one epoch: none is written over another that a row refers to.
        name = f"epoch-{epoch:04}-attempt-{self.run.attempt}-{self._checkpoints}"
        folder = run_folder(self.run.pk) / "checkpoints" / name
        digest = write_folder(folder, write)
        try:
            forgotten = lifecycle.record_checkpoint(
                self.run, epoch, stored_name(folder), digest, is_best
            )
        except (Fenced, DatabaseAway):
            remove_folder(folder)
            raise
        for other in forgotten:
            remove_folder(stored_folder(other))
        self._kept = time.monotonic()
        self._writing = self._kept - began

    def last_checkpoint(self) -> Path | None:
        """Return the newest checkpoint whose files are unaltered; None if there is none."""
        for checkpoint in self.run.checkpoints.order_by("-epoch", "-id"):
            folder = stored_folder(checkpoint.folder)
            if folder.is_dir() and digest_of(folder) == checkpoint.sha256:
                return folder
            self.log(
                f"The checkpoint of epoch {checkpoint.epoch} is missing or altered ({folder}), so it "
                "is not used."
            )
        return None
