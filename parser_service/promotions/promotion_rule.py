"""Verb: consider a run that has succeeded. Until a person chooses, whatever is better on paraphrases is promoted."""

from __future__ import annotations

from django.db import transaction

from annotations.language.corpus import Criterion
from annotations.models import Split, World
from annotations.people.audit_log import RULE, record_command
from parser_service.models import Promotion, PromotionState, TrainingRun
from parser_service.parsers.registry import Needs, needing
from parser_service.promotions.promoting import promote
from parser_service.promotions.score_evidence import (
    evidence_for,
    is_right_on_paraphrases,
    known_low,
    spoken_low,
    spoken_score,
)

FIRST = "The first run of this world that is right on paraphrases."


def consider(run: TrainingRun) -> Promotion | None:
    """Promote a run that has succeeded, or propose it, where it is better than the promoted one.

    The first run of a world that is right on some paraphrase is promoted. A later one takes its place where the
    lower end of its 95 % interval on validation paraphrases is higher. Both have to be tested on the same split,
    or the later one on a split that was frozen anew from it. One more case can be compared: the later run is on a
    split by command, the promoted one on a split by form, and the lower end on its known forms counts.

    What a person has promoted stays until a person decides: a better run is proposed. So is one after the corpus has
    changed that is not clearly worse: its accuracy is within the interval of the promoted run's.

    A parser that asks a server is never promoted here: what a robot hears would go there. Runs on a share of the
    training pairs do not count. Returns the row that was made, if any.
    """
    run = TrainingRun.objects.select_related("world", "split").get(pk=run.pk)
    if run.train_share != 1 or not is_right_on_paraphrases(run):
        return None
    with transaction.atomic():
        World.objects.select_for_update().get(pk=run.world_id)
        present = run.world.promotions.promoted().select_related("run__split").first()
        is_for_people = run.parser in needing(Needs.SERVER)
        if present is None:
            return None if is_for_people else _promote(run, FIRST)
        if is_comparable(run, present.run):
            better = _how_much_better(run, present.run)
        else:
            better = _how_much_better_on_known_forms(run, present.run)
        if better and present.decided_by is None and not is_for_people:
            return _promote(run, better)
        return _propose(run, present.run, better)


def is_comparable(run: TrainingRun, present: TrainingRun) -> bool:
    """Return whether figures of ``run`` can stand beside those of ``present``: on the same split, or on one that
    follows it."""
    return run.split == present.split or _follows(run.split, present.split)


def _promote(run: TrainingRun, reason: str) -> Promotion:
    row = promote(run, None, reason)
    record_command("promote a run", f"run {run.pk}: {reason}", run.world, who=RULE)
    return row


def _how_much_better(run: TrainingRun, present: TrainingRun) -> str:
    """Say by how much ``run`` is surer to be right than ``present``; nothing where it is not."""
    now, before = spoken_low(run), spoken_low(present)
    if now is None or before is None or now <= before:
        return ""
    return (
        f"Surer to be right than run {present.pk}: at least {_percent(now)} on validation paraphrases, "
        f"{_percent(before)} so far (lower ends of the 95 % intervals)."
    )


def _how_much_better_on_known_forms(run: TrainingRun, present: TrainingRun) -> str:
    """Say by how much ``run``, on a split by command, is surer to be right than ``present``, on one by form; nothing
    where it is not, or where they are on other splits.

    By command, parsers are asked for forms that they know. That is what most people say, so a figure of it may take
    the place of one by form, and not the other way round.
    """
    if (run.split.criterion, present.split.criterion) != (
        Criterion.COMMAND,
        Criterion.LOGICAL_FORM,
    ):
        return ""
    now, before = spoken_low(run), known_low(present)
    if now is None or now <= before:
        return ""
    return (
        f"Surer to be right than run {present.pk} on forms that training has: at least {_percent(now)} on "
        f"{run.split.name}, {_percent(before)} on {present.split.name} so far (lower ends of the 95 % intervals)."
    )


def _propose(run: TrainingRun, present: TrainingRun, better: str) -> Promotion | None:
    """Propose ``run`` where it is better, or the corpus has changed and it is not clearly worse."""
    now, before = spoken_score(run), spoken_score(present)
    if now is None or before is None:
        return None
    has_changed = _follows(run.split, present.split)
    if not better and (not has_changed or now.accuracy < before.interval_low):
        return None
    waiting = run.world.promotions.proposed()
    for other in waiting.select_related("run__split"):
        rival = spoken_score(other.run)
        if rival and rival.accuracy > now.accuracy and not _follows(run.split, other.run.split):
            return None
    waiting.overtake(by=None)
    after = (
        f"Trained on {run.split.name}, after the corpus changed since {present.split.name}: "
        f"{_percent(now.accuracy)} on validation paraphrases, {_percent(before.accuracy)} so far."
    )
    return Promotion.objects.create(
        world=run.world,
        run=run,
        state=PromotionState.PROPOSED,
        reason=after if has_changed else better,
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
