"""What answering UNKNOWN below a bound on the score would cost and save, for each source of a part."""

from __future__ import annotations

from typing import Any

import numpy as np

from annotations.background.progress import Progress
from annotations.language.forms import UNKNOWN, canonical_text
from parser_service.analysing.target import Target
from parser_service.analysis.arrays import Bools, Floats
from parser_service.analysis.probabilities import NO_PROBABILITY, calibration, probability_of
from parser_service.analysis.risk_coverage import risk_coverage

MOST_POINTS = 200
_COUNTS = ("answered", "wrong", "lost", "gained", "spared")


def refusal_findings(target: Target, progress: Progress) -> dict[str, dict[str, Any]]:
    """Return source → the risk–coverage curve in at most ``MOST_POINTS`` bounds, from the highest down.

    The first bound is None: nothing is answered. Examples without an answer are refused already, and
    only counted. A source without any answer has no curve.
    """
    curves = {}
    for source in target.sources:
        progress.check()
        if curve := _curve(target, target.answers.of_source(source)):
            curves[source] = curve
    return curves


def _curve(target: Target, mask: Bools) -> dict[str, Any] | None:
    answers = target.answers
    has_answer = np.fromiter(map(bool, answers.answers), dtype=np.bool_)
    chosen = mask & has_answer
    if not chosen.any():
        return None
    unknown = canonical_text(UNKNOWN)
    is_unknown = np.fromiter((label == unknown for label in answers.labels), dtype=np.bool_)
    # JSON has no infinity, which the log of a probability may be.
    scores = np.nan_to_num(answers.scores[chosen], neginf=-1e300, posinf=1e300)
    curve = risk_coverage(scores, answers.is_right[chosen], is_unknown[chosen]).thin(MOST_POINTS)
    return {
        "count": curve.count,
        "correct": curve.correct,
        "unanswered": int((mask & ~has_answer).sum()),
        "area": curve.area,
        "best_area": curve.best_area,
        "bounds": [None, *curve.bounds[1:].tolist()],
        **{name: getattr(curve, name).tolist() for name in _COUNTS},
        **_calibration(scores, answers.is_right[chosen], target.run.score_kind),
    }


def _calibration(scores: Floats, is_right: Bools, kind: str) -> dict[str, Any]:
    """Return expected calibration error and Brier score of the answers, or the sentence why they have none."""
    probabilities = [probability_of(score, kind) for score in scores.tolist()]
    if None in probabilities:
        return {"no_probability": NO_PROBABILITY}
    measured = calibration(probabilities, is_right)  # type: ignore[arg-type]
    return {"calibration_error": measured.error, "brier_score": measured.brier}
