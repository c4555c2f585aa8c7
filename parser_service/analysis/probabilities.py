"""Do the scores of a parser mean what they say? Of the answers given with 80 %, 80 of 100 should be right.

Expected calibration error: Naeini, Cooper and Hauskrecht, Obtaining well calibrated probabilities using
Bayesian binning, AAAI 2015; Guo et al., On calibration of modern neural networks, ICML 2017. Brier score:
Brier, Verification of forecasts expressed in terms of probability, Monthly Weather Review 78, 1950.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp

import numpy as np
from numpy.typing import ArrayLike

from annotations.language.corpus import wilson_interval
from parser_service.analysis.arrays import Bools

BINS = 10
NO_PROBABILITY = (
    "The scores of this parser are no probabilities, so neither the expected calibration error nor the "
    "Brier score means anything."
)


@dataclass(frozen=True, slots=True)
class Bin:
    """The ``count`` answers whose probability is above ``low`` and up to ``high``; the first bin also has those
    of 0. ``confidence`` is the mean probability, ``accuracy`` the share that is right."""

    low: float
    high: float
    count: int
    confidence: float
    accuracy: float

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval of the accuracy: Wilson's."""
        return wilson_interval(self.accuracy * self.count, self.count)


@dataclass(frozen=True, slots=True)
class Reliability:
    """``error`` is the expected calibration error: the mean over all answers of how far the accuracy of their
    bin is from its confidence. ``brier`` is the mean squared distance of the probability from 1 for a
    right answer and from 0 for a wrong one. Both are 0 at best; bins without an answer are left out."""

    error: float
    brier: float
    bins: tuple[Bin, ...]


def probability_of(score: float, kind: str | None) -> float | None:
    """Return the probability that a score of this ``ScoreKind`` says, or None where it says none; that of no
    answer, −∞, is 0."""
    if kind == "log_probability":
        return exp(min(score, 0.0))  # rounding may take it above
    if kind == "probability":
        return min(max(score, 0.0), 1.0)
    return None


def reliability(probabilities: ArrayLike, correct: Bools, bins: int = BINS) -> Reliability:
    """Measure how well the probabilities of answers are calibrated, in bins of equal width.

    Args:
        probabilities: of each answer, 0 to 1; 0 where there is no answer: [examples].
        correct: whether each answer is right, [examples].

    Raises:
        ValueError: there is no example, or a number is no probability.
    """
    given = np.asarray(probabilities, dtype=float)
    right = np.asarray(correct, dtype=float)
    if not len(given):
        raise ValueError("There is no answer to calibrate.")
    if not ((given >= 0) & (given <= 1)).all():
        raise ValueError("A score is no probability: it is not from 0 to 1.")
    place = np.clip(np.ceil(given * bins).astype(int) - 1, 0, bins - 1)  # [examples]
    filled = []
    for at in np.unique(place):
        inside = place == at  # [examples]
        means = float(given[inside].mean()), float(right[inside].mean())
        filled.append(Bin(at / bins, (at + 1) / bins, int(inside.sum()), *means))
    error = sum(each.count * abs(each.accuracy - each.confidence) for each in filled) / len(given)
    return Reliability(error, float(((given - right) ** 2).mean()), tuple(filled))
