"""A risk–coverage curve in words: what each bound on the score costs and saves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from annotations.language.english import say_count


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
    """Return the points of a curve (``analysing.refusals.refusing``), from the lowest bound, where everything is
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
    return RefusalPoint(
        bound=_number(bound),
        shown=_with_minus(bound) or "any score",
        sentence=_sentence(bound, answered == count, lost, gained, spared),
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


def _sentence(bound: float | None, is_all: bool, lost: int, gained: int, spared: int) -> str:
    if is_all:
        return "Everything is answered: nothing is lost, and no wrong answer is withheld."
    where = "to everything" if bound is None else f"below a score of {_with_minus(bound)}"
    right = f" and makes {say_count(gained, 'utterance')} right" if gained else ""
    return (
        f"Answering UNKNOWN {where} withholds {say_count(spared, 'wrong answer')}{right}, and loses "
        f"{say_count(lost, 'right answer')}."
    )


def _number(bound: float | None) -> str:
    return "" if bound is None else f"{bound:.4g}"


def _with_minus(bound: float | None) -> str:
    """Write a bound as pages show it, with a minus sign rather than a hyphen."""
    return _number(bound).replace("-", "−")
