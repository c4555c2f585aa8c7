"""Trains a claimed run, the same in a worker's child and in the foreground."""

from __future__ import annotations

import errno
import logging
import time
from collections.abc import Callable

from django.db import InterfaceError, OperationalError

from annotations.models.splits import Part
from parser_service import lifecycle
from parser_service.checkpoints import model_folder, write_folder
from parser_service.evaluating import evaluate
from parser_service.examples import pairs_of
from parser_service.knowledge import knowledge_of
from parser_service.leasing import Lease
from parser_service.models import TrainingRun
from parser_service.observing import TRAINING_SHARE, RunObserver, tell_nobody
from parser_service.parsers import registry
from parser_service.parsers.interface import Cancelled, Parser

logger = logging.getLogger(__name__)


def train(
    run: TrainingRun,
    give_up: Callable[[], None] | None = None,
    tell: Callable[[str], None] = tell_nobody,
) -> None:
    """Trains ``run``, which this process has claimed, to its end: evaluated, or failed with a reason.

    ``give_up`` is called where training does not notice in time that it is to stop; ``tell`` hears
    what the log says. Whatever happens is in the row; nothing is raised but what ends the process.
    While the database is away nothing can be recorded: the run goes on when its lease is over.
    """
    try:
        with Lease(run, give_up) as lease:
            _train(run, lease, RunObserver(lease, tell))
    except lifecycle.Fenced as fenced:
        logger.warning("%s", fenced)
    except (InterfaceError, OperationalError) as error:
        logger.warning("The database was away, so run %s goes on later: %s", run.pk, error)


def _train(run: TrainingRun, lease: Lease, observe: RunObserver) -> None:
    try:
        _fit_and_evaluate(run, observe)
    except (lifecycle.Fenced, InterfaceError, OperationalError):
        raise
    except Cancelled:
        if not lease.is_lost:
            lifecycle.acknowledge_cancel(run)
    except Exception as error:
        logger.exception("Run %s failed.", run.pk)
        lifecycle.fail(run, sentence_of(error))


def _fit_and_evaluate(run: TrainingRun, observe: RunObserver) -> None:
    began = time.monotonic()
    train_pairs = pairs_of(run.split, Part.TRAIN, run.train_sources)
    validation = pairs_of(run.split, Part.VALIDATION, run.train_sources)
    parser = untrained(run)
    observe.log(f"{len(train_pairs)} pairs to train on, {len(validation)} to choose by.")
    parser.fit(train_pairs, validation, observe)
    lifecycle.progress(run, TRAINING_SHARE, "saving the parser")
    write_folder(model_folder(run.pk), parser.save)
    evaluate(run, parser, validation, observe)
    epochs = sum(run.epochs.values_list("seconds", flat=True))
    lifecycle.finish(run, parser.parameters(), epochs or time.monotonic() - began)


def untrained(run: TrainingRun) -> Parser:
    """The run's parser before training, with what its protocol allows it to know and no more."""
    parser_class = registry.load_class(run.parser)
    config = registry.make_config(run.parser, run.config)
    return parser_class(config, run.seed, knowledge_of(run.world, run.protocol))


def sentence_of(error: Exception) -> str:
    """What stopped a run and what to do about it. A ValueError of ours says both itself."""
    if isinstance(error, ValueError):
        return str(error)
    if isinstance(error, OSError) and error.errno == errno.ENOSPC:
        return "The disk is full. Free space in GPSR_VAR_DIR, then start the run again."
    if isinstance(error, MemoryError) or type(error).__name__ == "OutOfMemoryError":
        return "The memory ran out. Train with a smaller batch or network, or on another machine."
    return (
        f"The program has a fault: {type(error).__name__}: {error}. The worker's log shows where; "
        "report it with the number of this run."
    )
