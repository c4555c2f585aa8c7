"""What answering UNKNOWN below a bound on the score would cost and save: the risk–coverage curve, and it in words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from annotations.background.progress import Progress
from annotations.language.forms import UNKNOWN, canonical_text
from annotations.language.texts import say_count
from parser_service.analysis.arrays import Bools
from parser_service.analysis.probabilities import NO_PROBABILITY, probability_of, reliability
from parser_service.analysis.risk_coverage import risk_coverage
from parser_service.reviews.target import Target

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
    probabilities = [probability_of(score, target.run.score_kind) for score in scores.tolist()]
    if None in probabilities:
        about_scores: dict[str, Any] = {"no_probability": NO_PROBABILITY}
    else:
        measured = reliability(probabilities, answers.is_right[chosen])  # type: ignore[arg-type]
        about_scores = {"calibration_error": measured.error, "brier_score": measured.brier}
    curve = risk_coverage(scores, answers.is_right[chosen], is_unknown[chosen]).thin(MOST_POINTS)
    return {
        "count": curve.count,
        "correct": curve.correct,
        "unanswered": int((mask & ~has_answer).sum()),
        "area": curve.area,
        "best_area": curve.best_area,
        "bounds": [None, *curve.bounds[1:].tolist()],
        **{name: getattr(curve, name).tolist() for name in _COUNTS},
        **about_scores,
    }


@dataclass(frozen=True, slots=True)
class RefusalPoint:
    """What happens where answers with a score below ``bound`` become UNKNOWN.

    ``bound`` is a number as addresses have it, empty where nothing is answered; ``shown`` is the same as
    people read it. ``facts`` are texts in the order of ``FACTS``; ``coverage`` and ``risk`` are in percent,
    the latter None without an answer.
    """

    bound: str
    shown: str
    sentence: str
    facts: tuple[str, ...]
    coverage: float
    risk: float | None


FACTS = (
    "Still answered",
    "Wrong among them",
    "Saved: wrong ones withheld",
    "Lost: right ones withheld",
    "Right as UNKNOWN",
    "Exact match",
)


def points_of(curve: Mapping[str, Any]) -> list[RefusalPoint]:
    """Return the points of a curve of ``refusal_findings``, from the lowest bound, where everything is
    answered, to the highest."""
    return [_point(curve, place) for place in reversed(range(len(curve["bounds"])))]


def place_of(points: list[RefusalPoint], bound: str) -> int:
    """Return which point is nearest to a bound that somebody asks for; the first for what is no number."""
    try:
        wanted = float(bound)
    except ValueError:
        return 0
    if wanted != wanted:
        return 0
    numbered = [place for place, point in enumerate(points) if point.bound]
    return min(numbered, key=lambda place: abs(float(points[place].bound) - wanted), default=0)


def curve_chart(points: list[RefusalPoint], mark: int) -> dict[str, Any]:
    """Return the chart of risk by coverage; the point ``mark`` is marked."""
    most = max((point.risk for point in points if point.risk is not None), default=0.0)
    return {
        "kind": "lines",
        "x": {
            "label": "answered, %",
            "values": [f"{point.coverage:.0f}" for point in points],
            "ticks": [100, 75, 50, 25, 0],
        },
        "y": {"label": "wrong", "unit": "%", **({"max": 100} if most > 75 else {})},
        "series": [{"name": "wrong", "values": [point.risk for point in points]}],
        "mark": mark,
        "done": True,
    }


def _point(curve: Mapping[str, Any], place: int) -> RefusalPoint:
    count, bound = curve["count"], curve["bounds"][place]
    answered, wrong, lost, gained, spared = (
        curve[name][place] for name in ("answered", "wrong", "lost", "gained", "spared")
    )
    risk = 100 * wrong / answered if answered else None
    before, after = curve["correct"], curve["correct"] - lost + gained
    if answered == count:
        sentence = "Everything is answered: nothing is lost, and no wrong answer is withheld."
    else:
        where = "to everything" if bound is None else f"below a score of {_with_minus(bound)}"
        right = f" and makes {say_count(gained, 'utterance')} right" if gained else ""
        sentence = (
            f"Answering UNKNOWN {where} withholds {say_count(spared, 'wrong answer')}{right}, and loses "
            f"{say_count(lost, 'right answer')}."
        )
    return RefusalPoint(
        bound=_number(bound),
        shown=_with_minus(bound) or "any score",
        sentence=sentence,
        facts=(
            f"{answered:,} of {count:,} ({100 * answered / count:.1f} %)",
            "–" if risk is None else f"{wrong:,} ({risk:.1f} %)",
            f"{spared:,}",
            f"{lost:,}",
            f"{gained:,}",
            f"{100 * before / count:.1f} % → {100 * after / count:.1f} %",
        ),
        coverage=100 * answered / count,
        risk=risk,
    )


def _number(bound: float | None) -> str:
    return "" if bound is None else f"{bound:.4g}"


def _with_minus(bound: float | None) -> str:
    """Write a bound as pages show it, with a minus sign rather than a hyphen."""
    return _number(bound).replace("-", "−")
