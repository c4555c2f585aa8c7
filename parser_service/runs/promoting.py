"""Verbs: make a run the learned part of what answers in its world, go back to the one before, decline a proposal."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from http import HTTPStatus

from django.db import transaction
from django.db.models import QuerySet
from django.utils import timezone

from annotations.language.texts import Refusal
from annotations.models import User, World
from annotations.models.background import Status
from parser_service.models import Promotion, PromotionState, TrainingRun
from parser_service.models.answering import answering_of
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.registry import Needs, needing, title_of, untrained
from parser_service.runs.score_evidence import evidence_for

MOST_REASON = 500  # characters


def promoted_run(world: World) -> TrainingRun | None:
    """Return the run that was promoted last in ``world``; None before the first promotion."""
    present = world.promotions.promoted().select_related("run__split").first()
    return present.run if present else None


def learned_part(world: World) -> TrainingRun | None:
    """Return the run that is the learned part of what answers in ``world``: the promoted one.

    None before the first promotion, and where an older version promoted a run of the grammar oracle: the oracle answers
    from the world as it is now, not from a run.
    """
    run = promoted_run(world)
    return run if run and is_learned(run) else None


def last_runs() -> QuerySet[TrainingRun]:
    """Return the runs that can be the last part of what answers in their world, the newest first.

    They ask a language model, and know the predicates to which its answers are held.
    """
    asking = needing(Needs.SERVER)
    runs = TrainingRun.objects.succeeded().filter(parser__in=asking, protocol=Protocol.DOMAIN)
    return runs.order_by("-pk")


def last_part(world: World) -> TrainingRun | None:
    """Return the run that is asked last in ``world``; None where no language model is asked there or has a run."""
    if not answering_of(world).asks_language_model:
        return None
    return last_runs().filter(world=world).first()


def is_learned(run: TrainingRun) -> bool:
    """Return whether a run can be the learned part: its parser learns from pairs."""
    return run.parser not in untrained()


def previous_run(world: World) -> TrainingRun | None:
    """Return the learned part before the present one; None where there was none.

    Runs of parsers that learn nothing do not count. After rolling back it is the one before that to which was rolled
    back, so that going back again goes further back.
    """
    rows = world.promotions.promoted().select_related("run__split")
    line: list[TrainingRun] = []  # the runs that a person would undo, one after the other
    for row in reversed(rows):
        if row.run in line:
            del line[line.index(row.run) + 1 :]
        else:
            line.append(row.run)
    return next((run for run in reversed(line[:-1]) if is_learned(run)), None)


def promote(run: TrainingRun, by: User | None, reason: str = "") -> Promotion:
    """Make ``run`` the learned part of what answers in its world. ``by`` is None where a rule decides.

    An open proposal of this run becomes the promotion; those of other runs are overtaken. Raises
    Refusal where its parser learns nothing, where the run has not succeeded, or is promoted already.
    """
    if not is_learned(run):
        raise Refusal(
            f"The {title_of(run.parser).lower()} answers from the world as it is and needs no run, so there is nothing "
            "to promote. Promote a run of a parser that learns: it answers where the oracle is silent.",
            "needs_no_run",
            HTTPStatus.CONFLICT,
        )
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
    """Promote the learned part before the present one. Raises Refusal where there is none."""
    run = previous_run(world)
    if run is None:
        raise Refusal(
            "No other run was promoted in this world before, so there is none to go back to.",
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
        World.objects.hold().get(pk=world.pk)
        yield


def _short(reason: str) -> str:
    return " ".join(reason.replace("\0", "").split())[:MOST_REASON]
