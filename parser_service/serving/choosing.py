"""Which run of a world to ask where nobody names one."""

from __future__ import annotations

from annotations.models import World
from annotations.models.background import Status
from parser_service.models import Evaluation, TrainingRun

# What a person says is what counts; of runs that were never tested on it, the next best.
EVIDENCE = ("para", "mixed", "gen")


def best_run(world: World) -> TrainingRun:
    """Return the succeeded run of ``world`` that is most often right on validation paraphrases.

    Runs on a share of the training pairs do not count. Of equally good ones the newest; where nothing
    was tested on paraphrases, generated commands decide. Raises ValueError, a sentence, where no run has
    succeeded.
    """
    tested = Evaluation.objects.filter(
        run__world=world, run__status=Status.SUCCEEDED, run__train_share=1, part="validation"
    )
    for source in EVIDENCE:
        best = tested.filter(test_source=source).order_by("-accuracy", "-run_id").first()
        if best:
            return best.run
    raise ValueError(f"No run of {world} has succeeded yet. Train a parser, then ask again.")
