"""Verb: request the runs of a learning curve, which differ by the share of the training pairs alone."""

from __future__ import annotations

from django.db import transaction

from annotations.models import User
from parser_service.models import TrainingRun
from parser_service.runs import requesting

SHARES = (0.1, 0.25, 0.5, 1.0)


def request_learning_curve(
    run: TrainingRun, by: User | None = None, send: bool = True
) -> list[TrainingRun]:
    """Request runs like ``run`` on all ``SHARES``, all or none, and return those that are new.

    Those that are there already are reused, ``run`` too unless its parser or what it knows of the world
    has changed since. Raises ValueError as ``requesting.request`` does.
    """
    with transaction.atomic():
        answers = [
            requesting.request(
                run.world,
                run.split,
                run.parser,
                run.config,
                run.protocol,
                run.train_sources,
                run.seed,
                by,
                send,
                anywhere=True,  # its weights were admitted when it was started
                train_share=share,
            )
            for share in SHARES
        ]
    return [each for each, is_new in answers if is_new]
