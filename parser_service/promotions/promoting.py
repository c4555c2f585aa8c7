"""Verbs: make a run the one that answers in its world, go back to the one before, decline a proposal."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from http import HTTPStatus

from django.db import transaction
from django.utils import timezone

from annotations.language.errors import Refusal
from annotations.models import User, World
from annotations.models.background import Status
from parser_service.models import Promotion, PromotionState, TrainingRun
from parser_service.promotions.score_evidence import evidence_for

MOST_REASON = 500  # characters


def promoted_run(world: World) -> TrainingRun | None:
    """Return the run that answers in ``world``; None before the first promotion."""
    present = world.promotions.promoted().select_related("run__split").first()
    return present.run if present else None


def previous_run(world: World) -> TrainingRun | None:
    """Return the run that answered before the present one; None where there was none.

    After rolling back it is the one before that to which was rolled back, so that going back again goes
    further back.
    """
    rows = world.promotions.promoted().select_related("run__split")
    line: list[TrainingRun] = []  # the runs that a person would undo, one after the other
    for row in reversed(rows):
        if row.run in line:
            del line[line.index(row.run) + 1 :]
        else:
            line.append(row.run)
    return line[-2] if len(line) > 1 else None


def promote(run: TrainingRun, by: User | None, reason: str = "") -> Promotion:
    """Let ``run`` answer in its world from now on. ``by`` is None where a rule decides.

    An open proposal of this run becomes the promotion; those of other runs are overtaken. Raises
    Refusal where the run has not succeeded or answers already.
    """
    if run.status != Status.SUCCEEDED:
        raise Refusal(
            f"Run {run.pk} is {run.status}; only a run that succeeded can be promoted.",
            "run_not_succeeded",
            HTTPStatus.CONFLICT,
        )
    with _deciding(run.world):
        before = promoted_run(run.world)
        if before == run:
            raise Refusal(
                f"Run {run.pk} is the promoted one already.",
                "promoted_already",
                HTTPStatus.CONFLICT,
            )
        waiting = run.world.promotions.proposed()
        row = waiting.filter(run=run).first() or Promotion(world=run.world, run=run)
        row.state, row.decided_at, row.decided_by = PromotionState.PROMOTED, timezone.now(), by
        row.reason = _short(reason) or row.reason
        row.evidence = evidence_for(run, before)
        row.save()
        waiting.exclude(pk=row.pk).overtake(by)
    return row


def roll_back(world: World, by: User, reason: str = "") -> Promotion:
    """Let the run answer that answered before the present one. Raises Refusal where there is none."""
    run = previous_run(world)
    if run is None:
        raise Refusal(
            "No other run answered in this world before, so there is none to go back to.",
            "no_run_before",
            HTTPStatus.CONFLICT,
        )
    return promote(run, by, f"Rolled back. {_short(reason)}".strip())


def decline(world: World, pk: int, by: User) -> Promotion:
    """Decline the open proposal ``pk``. Raises Refusal where it is not open any more."""
    with _deciding(world):
        row = world.promotions.proposed().filter(pk=pk).first()
        if row is None:
            raise Refusal(
                "This proposal was decided already.", "proposal_decided", HTTPStatus.CONFLICT
            )
        row.state, row.decided_at, row.decided_by = PromotionState.DECLINED, timezone.now(), by
        row.save(update_fields=["state", "decided_at", "decided_by"])
    return row


@contextmanager
def _deciding(world: World) -> Iterator[None]:
    """Let one decision about a world be made at a time."""
    with transaction.atomic():
        World.objects.select_for_update().get(pk=world.pk)
        yield


def _short(reason: str) -> str:
    return " ".join(reason.replace("\0", "").split())[:MOST_REASON]
