"""Wins, losses and ties of every pair of runs, and what they mean."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from annotations.language.english import say_count
from parser_service.analysis.arrays import Bools, Ints
from parser_service.analysis.clustered import accuracies_in_samples, p_values
from parser_service.analysis.comparing.significance import LEVEL, holm, mcnemar

SAMPLES = 5_000  # so that the least p-value of 66 pairs is significant after their correction


@dataclass(frozen=True, slots=True)
class Comparison:
    """Run ``first`` against run ``second``, by their places in the matrix, on ``count`` examples.

    ``wins`` counts the examples on which the first alone is right, ``losses`` the second alone, and ``ties``
    the rest. ``difference`` is first minus second accuracy, a fraction of 1, with the 95 % interval
    and the p-value of a paired bootstrap of whole clusters. ``corrected_p`` is it after Holm's correction.
    ``mcnemar_p`` is that of McNemar's test of single examples, with the same correction.
    """

    first: int
    second: int
    count: int
    wins: int
    losses: int
    difference: float
    interval: tuple[float, float]
    p: float
    corrected_p: float
    mcnemar_p: float

    @property
    def ties(self) -> int:
        return self.count - self.wins - self.losses

    @property
    def is_significant(self) -> bool:
        return self.corrected_p <= LEVEL

    def meaning(self, names: Sequence[str]) -> str:
        """Return the result as a sentence; ``names`` are those of all runs, in order."""
        first, second = names[self.first], names[self.second]
        if not self.wins + self.losses:
            return f"{first} and {second} are right on the same examples."
        if self.wins == self.losses:
            return (
                f"{first} and {second} are equally accurate, each right on "
                f"{say_count(self.wins, 'example')} where the other is not."
            )
        sign = 1 if self.difference >= 0 else -1
        better, worse = (first, second)[::sign]
        low, high = sorted(100 * sign * end for end in self.interval)
        evidence = (
            f"95 % interval {_number(low)} to {_number(high)} points, "
            f"{_p_value(self.corrected_p)} after Holm's correction"
        )
        points = _number(abs(100 * self.difference))
        if self.is_significant:
            return f"{better} is more accurate than {worse} by {points} points ({evidence})."
        return (
            f"{better} is ahead of {worse} by {points} points here, but that may be chance "
            f"({evidence})."
        )


def count_wins(correct: Bools) -> Ints:
    """Return on how many examples one run is right and another is wrong.

    Args:
        correct: whether each run is right on each example, [runs, examples].

    Returns:
        Counts, [runs, runs]: row the run that is right, column the run that is wrong.
    """
    packed = np.packbits(correct, axis=1)  # [runs, bytes]
    # Bits that fill up the last byte are 0, so they are wins of nobody.
    rows = [np.bitwise_count(right & ~packed).sum(axis=1, dtype=np.int64) for right in packed]
    return np.array(rows, dtype=np.int64).reshape(len(packed), len(packed))


def compare_runs(correct: Bools, clusters: Ints, samples: int = SAMPLES) -> tuple[Comparison, ...]:
    """Compare every pair of runs by a paired bootstrap: all are drawn with the same clusters. (Efron and Tibshirani
    1993; Koehn, Statistical significance tests for machine translation evaluation, 2004.)

    Args:
        correct: whether each run is right on each example, [runs, examples].
        clusters: the cluster of each example, as small whole numbers from 0 (``outcomes.encode_clusters``).
        samples: of the bootstrap.

    Raises:
        ValueError: there is no example.
    """
    count = correct.shape[1]
    if not count:
        raise ValueError("There is no example to compare runs on.")
    wins = count_wins(correct)
    pairs = list(combinations(range(len(correct)), 2))
    firsts, seconds = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    right, in_cluster = _count_by_cluster(correct, clusters)
    accuracies = accuracies_in_samples(right, in_cluster, samples)  # [runs, samples]
    differences = accuracies[firsts] - accuracies[seconds]  # [pairs, samples]
    p = p_values(differences, (right[firsts] != right[seconds]).sum(-1))
    ends = np.percentile(differences, [2.5, 97.5], axis=-1)
    corrected = holm(p)
    of_single = holm(mcnemar(wins[firsts, seconds], wins[seconds, firsts]))
    return tuple(
        Comparison(
            first=first,
            second=second,
            count=count,
            wins=int(wins[first, second]),
            losses=int(wins[second, first]),
            difference=int(wins[first, second] - wins[second, first]) / count,
            interval=(float(ends[0, at]), float(ends[1, at])),
            p=float(p[at]),
            corrected_p=float(corrected[at]),
            mcnemar_p=float(of_single[at]),
        )
        for at, (first, second) in enumerate(pairs)
    )


def _count_by_cluster(correct: Bools, clusters: Ints) -> tuple[Ints, Ints]:
    """Return the number of right answers, [runs, clusters], and of examples, [clusters]."""
    in_cluster: Ints = np.bincount(clusters)
    width = len(in_cluster)
    right: Ints = np.array([np.bincount(clusters[run], minlength=width) for run in correct])
    return right, in_cluster


def _number(points: float) -> str:
    return f"{round(points, 1) + 0.0:.1f}".replace("-", "−")  # + 0.0 makes −0.0 a 0


def _p_value(p: float) -> str:
    return "p < 0.001" if p < 0.001 else f"p = {p:.3f}"
