"""Verb: consider a run that has succeeded as the learned part of what answers in its world."""

from __future__ import annotations

from django.db import transaction

from annotations.language.corpus import Criterion
from annotations.models import Split, World
from annotations.people.audit_log import RULE, record_command
from parser_service.models import Promotion, PromotionState, TrainingRun
from parser_service.models.evaluations import ShownScore
from parser_service.parsers.conditions import in_words
from parser_service.parsers.registry import Needs, needing
from parser_service.runs.promoting import is_learned, promote
from parser_service.runs.score_evidence import evidence_for, judged_by, known_low, why_not

FIRST = "The first run of this world that is right more often than wrong."


def consider(run: TrainingRun) -> Promotion | None:
    """Promote a run that has succeeded, or propose it, where it is better than the promoted one.

    The first run of a world against which nothing speaks (``why_not``) is promoted. A later one takes its place where
    the lower end of its 95 % interval is higher, on validation utterances of people where there are enough
    (``judged_by``). Both have to be tested on the same split, or the later one on a split that was frozen anew from it.
    One more case can be compared: the later run is on a split by command, the promoted one on a split by form, and the
    lower end on its known forms counts.

    What a person has promoted stays until a person decides: a better run is proposed. So is one after the corpus has
    changed that is not clearly worse: its accuracy is within the interval of the promoted run's.

    A parser that asks a server is never promoted here: what a robot hears would go there. Runs of a parser that learns
    nothing, and runs on a share of the training pairs, do not count. Returns the row that was made, if any.
    """
    run = TrainingRun.objects.select_related("world", "split").get(pk=run.pk)
    if why_not(run):
        return None
    with transaction.atomic():
        World.objects.hold().get(pk=run.world_id)
        present = run.world.promotions.promoted().select_related("run__split").first()
        is_for_people = run.parser in needing(Needs.SERVER)
        if present is None or not is_learned(present.run):
            if is_for_people:
                return None
            if present is None or present.decided_by is None:
                return _promote(run, FIRST)
            return _propose(run, present.run, FIRST)
        if is_comparable(run, present.run):
            better = _how_much_better(run, present.run)
        else:
            better = _how_much_better_on_known_forms(run, present.run)
        if better and present.decided_by is None and not is_for_people:
            return _promote(run, better)
        return _propose_if_good(run, present.run, better)


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
    scores = judged_by(run, present)
    if not scores or any(score.alone for score in scores):
        return ""
    now, before = (score.interval[0] for score in scores)
    if now <= before:
        return ""
    return (
        f"Surer to be right than run {present.pk}: at least {_percent(now)} on validation {_words(scores[0])}, "
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
    scores, before = judged_by(run), known_low(present)
    if not scores or (now := scores[0].interval[0]) <= before:
        return ""
    return (
        f"Surer to be right than run {present.pk} on forms that training has: at least {_percent(now)} on "
        f"{run.split.name}, {_percent(before)} on {present.split.name} so far (lower ends of the 95 % intervals)."
    )


def _propose_if_good(run: TrainingRun, present: TrainingRun, better: str) -> Promotion | None:
    """Propose ``run`` where it is better, or the corpus has changed and it is not clearly worse."""
    scores = judged_by(run, present)
    if not scores:
        return None
    now, before = scores
    has_changed = _follows(run.split, present.split)
    if not better and (not has_changed or now.accuracy < before.score.interval_low):
        return None
    after = (
        f"Trained on {run.split.name}, after the corpus changed since {present.split.name}: "
        f"{_percent(now.accuracy)} on validation {_words(now)}, {_percent(before.accuracy)} so far."
    )
    return _propose(run, present, after if has_changed else better)


def _propose(run: TrainingRun, present: TrainingRun, reason: str) -> Promotion | None:
    """Propose ``run`` in the place of other proposals, unless one of them is better."""
    waiting = run.world.promotions.proposed()
    for other in waiting.select_related("run__split"):
        scores = judged_by(run, other.run)
        is_newer = _follows(run.split, other.run.split)
        if scores and scores[1].accuracy > scores[0].accuracy and not is_newer:
            return None
    waiting.overtake(by=None)
    return Promotion.objects.create(
        world=run.world,
        run=run,
        state=PromotionState.PROPOSED,
        reason=reason,
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


def _words(score: ShownScore) -> str:
    return in_words(score.score.test_source)
