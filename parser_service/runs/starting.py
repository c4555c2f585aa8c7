"""Verbs: start runs for somebody, within what they may start in an hour."""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus
from typing import Any

from django.db import transaction

from annotations.generation.renewing import last_of
from annotations.language.texts import Refusal
from annotations.models import User, World
from annotations.people.rate_limits import STARTED_RUNS
from parser_service.models import TrainingRun
from parser_service.runs.learning_curve import request_learning_curve
from parser_service.runs.run_requests import request_seeds, retrain

Answer = tuple[TrainingRun, bool]


class TooMany(Refusal):
    """Somebody asks for more runs than they may start within this hour."""

    code = "too_many_runs"
    status = HTTPStatus.TOO_MANY_REQUESTS


def start_runs(world: World, by: User, *, seeds: Sequence[int], **asked: Any) -> list[Answer]:
    """Request one run per seed, all or none. Return what ``request`` returns, in the order of ``seeds``.

    Raises TooMany, and Refusal as ``run_requests.request`` does.
    """
    require_left(by, len(seeds))
    answers = request_seeds(world, seeds=seeds, by=by, **asked)
    count_started(by, len(answers))
    return answers


def start_again(run: TrainingRun, by: User) -> Answer:
    """Request the configuration of ``run`` on the newest split that follows its own.

    Raises TooMany, and Refusal where its split has not been frozen anew, or as ``retrain`` does.
    """
    newest = last_of(run.split)
    if newest.pk == run.split_id:
        raise Refusal(
            f"{run.split} has not been frozen anew, so there is nothing to retrain on.",
            "split_not_frozen_anew",
        )
    require_left(by, 1)
    answer = retrain(run, newest, by)
    count_started(by, 1)
    return answer


def start_learning_curve(run: TrainingRun, by: User, n_seeds: int = 1) -> list[TrainingRun]:
    """Request the missing runs of a learning curve, all or none, and return them.

    Raises TooMany, and Refusal as ``request_learning_curve`` does.
    """
    with transaction.atomic():
        new = request_learning_curve(run, by, n_seeds=n_seeds)
        left = STARTED_RUNS.left(str(by.pk))
        if len(new) > left:
            raise TooMany(
                f"This learning curve needs {len(new)} more runs, and you may start {left} within this "
                "hour. Try again later."
            )
    count_started(by, len(new))
    return new


def require_left(by: User, asked: int) -> None:
    """Raise TooMany where somebody may not start as many runs within this hour."""
    left = STARTED_RUNS.left(str(by.pk))
    if asked <= left:
        return
    if left == 0:
        raise TooMany(
            f"You have started {STARTED_RUNS.limit} runs within the hour. "
            "Wait for some of them before you start more."
        )
    raise TooMany(
        f"{asked} runs are more than the {left} that you may still start within this hour. "
        "Ask for fewer, or try again later."
    )


def count_started(by: User, started: int) -> None:
    """Count runs against what somebody may start within this hour."""
    for _ in range(started):
        STARTED_RUNS.take(str(by.pk))
