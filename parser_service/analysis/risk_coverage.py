"""What answering UNKNOWN below a bound on the score costs and saves.

El-Yaniv and Wiener, On the foundations of noise-free selective classification, Journal of Machine
Learning Research 11, 2010: *coverage* is the share of utterances that are answered, *risk* the share of
those answers that are wrong. The area under the risk–coverage curve (AURC): Geifman, Uziel and El-Yaniv,
Bias-reduced uncertainty estimation for deep neural classifiers, ICLR 2019.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from parser_service.analysis.arrays import Bools, Floats, Ints


@dataclass(frozen=True, slots=True)
class Refusal:
    """What changes among ``count`` utterances where answers with a score below ``bound`` become UNKNOWN.

    Of the answers that are refused, ``lost`` were right and are wrong now, ``gained`` were wrong and are
    right now, since the label is UNKNOWN, and ``spared`` were wrong, so that the robot does
    nothing instead of something wrong. ``wrong`` of the ``answered`` are wrong. ``accuracy`` is that over
    all utterances after the change. ``risk`` is None without an answer.
    """

    bound: float
    count: int
    answered: int
    wrong: int
    lost: int
    gained: int
    spared: int
    accuracy: float

    @property
    def coverage(self) -> float:
        return self.answered / self.count

    @property
    def risk(self) -> float | None:
        return self.wrong / self.answered if self.answered else None


@dataclass(frozen=True, eq=False, slots=True)
class RiskCoverage:
    """The curve, a point for each bound; ``bounds`` are ∞ and the distinct scores, highest first.

    The other arrays have the fields of ``Refusal`` at each bound, [bounds]. ``area`` is the mean risk over
    all coverages, 0 for a parser without errors; ``best_area`` is what it would be if every wrong
    answer had a lower score than every right one.
    """

    count: int
    correct: int
    bounds: Floats
    answered: Ints
    wrong: Ints
    lost: Ints
    gained: Ints
    spared: Ints
    area: float
    best_area: float

    @property
    def coverage(self) -> Floats:
        """Fractions of 1, [bounds]."""
        return self.answered / self.count

    @property
    def risk(self) -> Floats:
        """Fractions of 1, [bounds]; NaN where nothing is answered."""
        with np.errstate(invalid="ignore"):
            return self.wrong / self.answered

    def at(self, bound: float) -> Refusal:
        """Return what changes where answers with a score below ``bound`` become UNKNOWN."""
        place = int(np.searchsorted(-self.bounds, -bound, side="right")) - 1
        lost, gained = int(self.lost[place]), int(self.gained[place])
        return Refusal(
            bound=bound,
            count=self.count,
            answered=int(self.answered[place]),
            wrong=int(self.wrong[place]),
            lost=lost,
            gained=gained,
            spared=int(self.spared[place]),
            accuracy=(self.correct - lost + gained) / self.count,
        )

    def thin(self, points: int) -> RiskCoverage:
        """Return the same curve with at most ``points`` bounds (2 or more), evenly spaced by coverage."""
        wanted = np.linspace(0, self.count, points)
        places = np.unique(np.searchsorted(self.answered, wanted))
        return replace(
            self,
            bounds=self.bounds[places],
            answered=self.answered[places],
            wrong=self.wrong[places],
            lost=self.lost[places],
            gained=self.gained[places],
            spared=self.spared[places],
        )


def risk_coverage(
    scores: ArrayLike, correct: Bools, is_unknown: Bools | None = None
) -> RiskCoverage:
    """Return the risk–coverage curve of one run.

    Args:
        scores: how sure the parser is of each answer, higher is surer, any unit: [examples].
        correct: whether each answer is right, [examples].
        is_unknown: whether the label of each example is UNKNOWN, so that refusing it is right,
            [examples]; by default of none.

    Raises:
        ValueError: there is no example, or a score is not a number.
    """
    values = np.asarray(scores, dtype=float)
    if not len(values):
        raise ValueError("There is no answer to draw a curve of.")
    if np.isnan(values).any():
        raise ValueError("A score is not a number.")
    unknown = np.zeros(len(values), dtype=bool) if is_unknown is None else is_unknown
    order = np.argsort(-values, kind="stable")
    ranked, right, refusable = values[order], correct[order], unknown[order]
    last = np.flatnonzero(np.append(ranked[1:] != ranked[:-1], True))  # of each distinct score

    def below(mask: Bools) -> Ints:
        """Count the examples of a mask that each bound refuses, [bounds]."""
        above = np.cumsum(mask, dtype=np.int64)
        return int(above[-1]) - np.append(0, above[last])

    wrong = below(~right)
    return RiskCoverage(
        count=len(values),
        correct=int(right.sum()),
        bounds=np.append(np.inf, ranked[last]),
        answered=np.append(0, last + 1),
        wrong=wrong[0] - wrong,
        lost=below(right & ~refusable),
        gained=below(~right & refusable),
        spared=below(~right & ~refusable),
        area=_area(~right, last),
        best_area=_area(np.sort(~right), np.arange(len(right))),
    )


def _area(wrong: Bools, last: Ints) -> float:
    """Return the mean of the risks at 1, 2, … answers; examples with equal scores are in random order,
    so that each of them counts as wrong to the same degree."""
    sizes = np.diff(last, prepend=-1)
    errors = np.diff(np.cumsum(wrong)[last], prepend=0)
    expected = np.cumsum(np.repeat(errors / sizes, sizes))
    return float(np.mean(expected / np.arange(1, len(wrong) + 1)))
