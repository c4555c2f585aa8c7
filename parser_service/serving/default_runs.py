"""Which run of a world to ask, and which one a page opens on, where nobody names one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from http import HTTPStatus

from django.db.models import Count, QuerySet

from annotations.language.corpus import Criterion
from annotations.language.errors import Refusal
from annotations.models import Split, World
from annotations.models.background import Status
from parser_service.models import Evaluation, TrainingRun
from parser_service.parsers.registry import Needs, needing
from parser_service.promotions.promoting import promoted_run

# What a person says is what counts; of runs that were never tested on it, the next best.
EVIDENCE = ("para", "said", "mixed", "gen")

# Criteria under which a figure says how well known forms are answered, which is what most people ask for.
BY_COMMAND = (Criterion.COMMAND, Criterion.SOURCE_COMMAND)


def best_run(world: World) -> TrainingRun:
    """Return the succeeded run of ``world`` that is surest to be right on validation paraphrases: the one
    with the highest lower end of the interval.

    Figures can be compared within one split alone. That is the one by command or source command with most runs
    to compare, of several the newest; where there is none, one by form. Runs on a share of the training
    pairs do not count, nor do those that ask a server, which is to hear only what somebody sends there.
    Where nothing was tested on paraphrases, generated commands decide. Raises Refusal
    where no run has succeeded.
    """
    tested = Evaluation.objects.filter(
        run__world=world, run__status=Status.SUCCEEDED, run__train_share=1, part="validation"
    ).exclude(run__parser__in=needing(Needs.SERVER))
    by_command = tested.filter(run__split__criterion__in=BY_COMMAND)
    for source in EVIDENCE:
        for comparable in (by_command, tested):
            best = _surest(comparable.filter(test_source=source))
            if best:
                return best.run
    raise Refusal(
        f"No run of {world} has succeeded yet. Train a parser, then ask again.",
        "no_succeeded_run",
        HTTPStatus.CONFLICT,
    )


def opening_run(world: World) -> TrainingRun | None:
    """Return the run that a page opens on: what answers in the world, else the best one.

    That is the promoted run, else ``best_run``, else the newest that has succeeded; None where there is none.
    """
    promoted = promoted_run(world)
    if promoted is not None:
        return promoted
    try:
        return best_run(world)
    except Refusal:
        return world.runs.succeeded().select_related("split").order_by("-pk").first()


def opening_split(world: World, splits: Sequence[Split], runs: Mapping[int, int]) -> Split | None:
    """Return the split of ``splits`` that a comparison of runs opens on.

    That is the one of ``opening_run`` where it has several runs to compare, else the one with most, the newest of those
    with equally many. ``runs`` counts them by the key of the split.
    """
    opening = opening_run(world)

    def rank(split: Split) -> tuple[bool, int, int]:
        count = runs.get(split.pk, 0)
        is_opening = opening is not None and opening.split_id == split.pk
        return is_opening and count > 1, count, split.pk

    return max(splits, key=rank, default=None)


def _surest(tested: QuerySet[Evaluation]) -> Evaluation | None:
    """Return the best of ``tested`` within the split that has most of them."""
    by_split = tested.values("run__split").annotate(runs=Count("run", distinct=True))
    split = by_split.order_by("-runs", "-run__split").first()
    if split is None:
        return None
    of_split = tested.filter(run__split=split["run__split"])
    return of_split.order_by("-interval_low", "-accuracy", "-run_id").first()
