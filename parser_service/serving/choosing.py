"""Which run of a world to ask where nobody names one."""

from __future__ import annotations

from django.db.models import Count, QuerySet

from annotations.language.corpus import Criterion
from annotations.models import World
from annotations.models.background import Status
from parser_service.models import Evaluation, TrainingRun
from parser_service.parsers.registry import Needs, needing

# What a person says is what counts; of runs that were never tested on it, the next best.
EVIDENCE = ("para", "mixed", "gen")


# Criteria under which a figure says how well known forms are answered, which is what most people ask for.
BY_COMMAND = (Criterion.COMMAND, Criterion.SOURCE_COMMAND)


def best_run(world: World) -> TrainingRun:
    """Return the succeeded run of ``world`` that is surest to be right on validation paraphrases: the one
    with the highest lower end of the interval.

    Figures can be compared within one split alone. That is the one by command or source command with most runs
    to compare, of several the newest; where there is none, one by form. Runs on a share of the training
    pairs do not count, nor do those that ask a server, which is to hear only what somebody sends there.
    Where nothing was tested on paraphrases, generated commands decide. Raises ValueError, a
    sentence, where no run has succeeded.
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
    raise ValueError(f"No run of {world} has succeeded yet. Train a parser, then ask again.")


def _surest(tested: QuerySet[Evaluation]) -> Evaluation | None:
    """Return the best of ``tested`` within the split that has most of them."""
    by_split = tested.values("run__split").annotate(runs=Count("run", distinct=True))
    split = by_split.order_by("-runs", "-run__split").first()
    if split is None:
        return None
    of_split = tested.filter(run__split=split["run__split"])
    return of_split.order_by("-interval_low", "-accuracy", "-run_id").first()
