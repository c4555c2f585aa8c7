"""Verb: request the runs of a learning curve, which differ by the share of the training pairs alone."""

from __future__ import annotations

from django.db import transaction

from annotations.models import User
from parser_service.models import TrainingRun
from parser_service.runs import run_requests

SHARES = (0.1, 0.25, 0.5, 1.0)
MOST_SEEDS = 5


def points_of(run: TrainingRun, n_seeds: int) -> list[tuple[float, int]]:
    """Return share and seed of each run of a learning curve, the seed of ``run`` being the first."""
    return [(share, run.seed + number) for number in range(n_seeds) for share in SHARES]


def request_learning_curve(
    run: TrainingRun, by: User | None = None, send: bool = True, n_seeds: int = 1
) -> list[TrainingRun]:
    """Request runs like ``run`` on all ``SHARES`` with ``n_seeds``, all or none, and return those that are new.

    Those that are there already are reused, ``run`` too unless its parser or what it knows of the world
    has changed since. Raises Refusal as ``run_requests.request`` does.
    """
    with transaction.atomic():
        answers = [
            run_requests.request(
                run.world,
                run.split,
                run.parser,
                run.config,
                run.protocol,
                run.train_sources,
                seed,
                by,
                send,
                anywhere=True,  # its weights were admitted when it was started
                train_share=share,
            )
            for share, seed in points_of(run, n_seeds)
        ]
    return [each for each, is_new in answers if is_new]
