"""What speaks for a run: its scores on what people said."""

from __future__ import annotations

from typing import Any

from parser_service.models import Evaluation, TrainingRun

SPOKEN = "para"  # the test source of paraphrases
# What runs are compared on: the test part is looked at when the choice is made.
COMPARED_ON = "validation"


def is_tested_on_paraphrases(run: TrainingRun) -> bool:
    return run.evaluations.filter(test_source=SPOKEN).exists()


def spoken_score(run: TrainingRun) -> Evaluation | None:
    """Return the score on validation paraphrases, None for a run that was not asked any."""
    return run.evaluations.filter(test_source=SPOKEN, part=COMPARED_ON).first()


def evidence_for(run: TrainingRun, before: TrainingRun | None) -> dict[str, Any]:
    """Return the scores of ``run`` and of the run ``before`` it, as ``Promotion.evidence`` keeps them."""
    compared = {"run": before.pk, "scores": _scores(before)} if before else None
    return {"run": _scores(run), "before": compared}


def _scores(run: TrainingRun) -> list[dict[str, Any]]:
    return [
        {
            "test_source": score.test_source,
            "part": score.part,
            "count": score.count,
            "accuracy": score.accuracy,
            "low": score.interval_low,
            "high": score.interval_high,
        }
        for score in run.evaluations.order_by("part", "test_source")
    ]
