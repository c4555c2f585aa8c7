"""Verb: consider a run that has succeeded. The first one is promoted; later ones can only be proposed."""

from __future__ import annotations

from django.db import transaction

from annotations.models import Split, World
from annotations.people.audit_log import RULE, record_command
from parser_service.models import Promotion, PromotionState, TrainingRun
from parser_service.parsers.registry import PARSERS, Needs, needing
from parser_service.promotion.evidence import (
    evidence_for,
    is_right_on_paraphrases,
    spoken_score,
)
from parser_service.promotion.verbs import promote, promoted_run

FIRST = "The first run of this world that was tested on paraphrases."


def consider(run: TrainingRun) -> Promotion | None:
    """Promote the first run of a world that was tested on paraphrases; propose one after retraining.

    The first one has to be right on some paraphrase. A parser that asks a server is left for people to
    promote: what a robot hears would go there. A parser that is trained in seconds, as those are that
    others are compared with, leaves it to others that wait or run in its world. A run is proposed where
    the corpus has changed (its split follows that of the promoted run) and it is not clearly worse on
    validation paraphrases: its accuracy there is within the 95 % interval of the promoted run's, or
    above. Runs on a share of the training pairs do not count. Nothing is switched but the first time.
    Returns the row that was made, if any.
    """
    run = TrainingRun.objects.select_related("world", "split").get(pk=run.pk)
    if run.train_share != 1 or not is_right_on_paraphrases(run):
        return None
    with transaction.atomic():
        World.objects.select_for_update().get(pk=run.world_id)
        present = promoted_run(run.world)
        if present is None:
            is_for_people = run.parser in needing(Needs.SERVER)
            is_left = is_for_people or _leaves_it_to_others(run)
            return None if is_left else _promote_first(run)
        return _propose(run, present)


def _promote_first(run: TrainingRun) -> Promotion:
    row = promote(run, None, FIRST)
    record_command("promote a run", f"run {run.pk}: {FIRST}", run.world, who=RULE)
    return row


def _leaves_it_to_others(run: TrainingRun) -> bool:
    """Return whether ``run`` is of a parser that needs nothing, and one that needs more is on its way."""
    rivals = run.world.runs.active().exclude(pk=run.pk).values_list("parser", flat=True)
    return _needs_nothing(run.parser) and not all(map(_needs_nothing, rivals))


def _needs_nothing(parser: str) -> bool:
    return parser in PARSERS and PARSERS[parser].needs is Needs.NOTHING


def _propose(run: TrainingRun, present: TrainingRun) -> Promotion | None:
    now, before = spoken_score(run), spoken_score(present)
    if now is None or before is None or not _follows(run.split, present.split):
        return None
    if now.accuracy < before.interval_low:
        return None
    waiting = run.world.promotions.proposed()
    for other in waiting.select_related("run"):
        rival = spoken_score(other.run)
        if rival and rival.accuracy > now.accuracy and not _follows(run.split, other.run.split):
            return None
    waiting.update(state=PromotionState.OVERTAKEN)
    return Promotion.objects.create(
        world=run.world,
        run=run,
        state=PromotionState.PROPOSED,
        reason=(
            f"Trained on {run.split.name}, after the corpus changed since {present.split.name}: "
            f"{_percent(now.accuracy)} on validation paraphrases, {_percent(before.accuracy)} so far."
        ),
        evidence=evidence_for(run, present),
    )


def _follows(later: Split, earlier: Split) -> bool:
    """Return whether ``later`` was frozen anew from ``earlier``, directly or over others."""
    seen: set[int] = set()
    step: Split | None = later
    while step is not None and step.pk not in seen:
        seen.add(step.pk)
        step = step.follows
        if step == earlier:
            return True
    return False


def _percent(fraction: float) -> str:
    return f"{100 * fraction:.1f} %"
