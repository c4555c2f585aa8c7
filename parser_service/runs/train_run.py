"""Trains a claimed run, in a worker's child or in the foreground."""

from __future__ import annotations

import time
from collections.abc import Callable

from annotations.background import (
    Lease,
    Stopped,
    failure_sentence,
    is_out_of_memory,
    while_held,
)
from annotations.labelling.proposal_requests import request_proposals
from annotations.language.corpus import Part
from parser_service.models import PromotionState, TrainingRun
from parser_service.parsers import registry
from parser_service.parsers.interface import Cancelled, Parser
from parser_service.runs import lifecycle
from parser_service.runs.analysis_requests import request_analysis, request_measurement_with
from parser_service.runs.checkpoints import model_folder, write_folder
from parser_service.runs.evaluating import evaluate
from parser_service.runs.knowledge import knowledge_of
from parser_service.runs.observing import TRAINING_SHARE, RunObserver, tell_nobody
from parser_service.runs.orphan_folders import keep_track_of
from parser_service.runs.promotion_rule import consider
from parser_service.runs.split_pairs import known_examples, pairs_of, training_pairs


def train(
    run: TrainingRun,
    give_up: Callable[[], None] | None = None,
    tell: Callable[[str], None] = tell_nobody,
) -> None:
    """Train and evaluate ``run``, which this process has claimed.

    ``give_up`` is called where training does not notice in time that it is to stop; ``tell`` hears
    what the log says. Whatever happens is in the row; nothing is raised but what ends the process.
    """

    def do(lease: Lease) -> None:
        try:
            _fit_and_evaluate(run, RunObserver(lease, tell))
        except Cancelled as error:  # what RunObserver.check makes of Stopped
            raise Stopped(str(error)) from error

    while_held(run, do, give_up, sentence_of)


def _fit_and_evaluate(run: TrainingRun, observe: RunObserver) -> None:
    began = time.monotonic()
    keep_track_of(run)
    known = known_examples(run.split, run.seed)
    held_out = {each.pk for each in known}
    train_pairs = training_pairs(run.split, run.train_sources, run.train_share, run.seed, held_out)
    validation = pairs_of(run.split, Part.VALIDATION, run.train_sources)
    parser = make_parser(run)
    observe.log(f"{len(train_pairs)} pairs to train on, {len(validation)} to choose by.")
    if known:
        observe.log(f"{len(known)} pairs of known forms are held out of the training part.")
    parser.fit(train_pairs, validation, observe)
    lifecycle.record_progress(run, TRAINING_SHARE, "saving the parser")
    write_folder(model_folder(run.pk), parser.save)
    evaluate(run, parser, train_pairs, validation, observe, known)
    epochs = sum(run.epochs.values_list("seconds", flat=True))
    lifecycle.finish(run, parser.parameters(), epochs or time.monotonic() - began)
    request_proposals(run.world)  # it may be the best parser now
    if not parser.asks_a_server:  # thousands of questions to it, so somebody has to want that
        request_analysis(run)
    row = consider(run)
    if row is not None and row.state == PromotionState.PROMOTED:
        request_measurement_with(run)


def make_parser(run: TrainingRun) -> Parser:
    """Make the run's parser, untrained, with what its protocol allows it to know."""
    parser_class = registry.load_class(run.parser)
    config = registry.make_config(run.parser, run.config)
    return parser_class(config, run.seed, knowledge_of(run.world, run.protocol))


def sentence_of(error: Exception) -> str:
    """Say what stopped a run and what to do about it."""
    if is_out_of_memory(error):
        return "The memory ran out. Train with a smaller batch or network, or on another machine."
    return failure_sentence(error, TrainingRun.noun)
