"""Compare runs on the same examples: win, loss and tie, and whether the difference may be chance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from annotations.language.texts import say_count
from parser_service.analysis.arrays import Bools, Floats, Ints
from parser_service.analysis.clustered import Parts, accuracies_in_samples, compare, p_values

LEVEL = 0.05  # a corrected p-value up to this is called significant
SAMPLES = 5_000  # so that the least p-value of 66 pairs is significant after their correction


def mcnemar(wins: ArrayLike, losses: ArrayLike) -> Floats:
    """Return the two-sided p-values of McNemar's exact test (Psychometrika 12, 1947), any shape.

    It is the binomial test that a win is as likely as a loss, 1 where there is neither. Every example counts as
    if it were drawn alone.
    """
    from scipy.special import bdtr  # a start can do without it

    first, second = np.asarray(wins, dtype=np.int64), np.asarray(losses, dtype=np.int64)
    one_sided: Floats = bdtr(np.minimum(first, second).astype(float), first + second, 0.5)
    return np.minimum(1.0, 2 * one_sided)


def holm(p_values: ArrayLike) -> Floats:
    """Return p-values corrected for the number of tests, [tests] (Holm, Scandinavian Journal of
    Statistics 6, 1979). Rejecting those up to 0.05 makes a single false finding at most 5 % likely."""
    p = np.asarray(p_values, dtype=float)
    order = np.argsort(p, kind="stable")
    factors = len(p) - np.arange(len(p))
    corrected = np.empty_like(p)
    corrected[order] = np.minimum(1.0, np.maximum.accumulate(p[order] * factors))
    return corrected


def is_better(best: Parts, others: Sequence[Parts]) -> bool:
    """Return whether ``best``, the highest of all, is better than each of the others, of which there is at
    least one.

    A paired bootstrap of clusters and trainings for each, with Holm's correction for their number.
    """
    if not others:
        return False
    p_values = [compare(best, other)[1] for other in others]
    return bool((holm(p_values) <= LEVEL).all())


@dataclass(frozen=True, slots=True)
class RunComparison:
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
        p = self.corrected_p
        evidence = (
            f"95 % interval {_number(low)} to {_number(high)} points, "
            f"p {'< 0.001' if p < 0.001 else f'= {p:.3f}'} after Holm's correction"
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


def compare_runs(
    correct: Bools, clusters: Ints, samples: int = SAMPLES
) -> tuple[RunComparison, ...]:
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
        RunComparison(
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
