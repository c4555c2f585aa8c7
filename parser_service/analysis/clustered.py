"""Accuracies whose examples are not independent: paraphrases of one command, utterances of one form.

A cluster is right or wrong together, so whole clusters are drawn (Davison and Hinkley, Bootstrap Methods and
their Application, 1997, §3.8). Where a parser was trained several times, trainings and clusters are drawn
independently of each other (Owen, The pigeonhole bootstrap, Annals of Applied Statistics 1, 2007).
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from annotations.language.corpus import wilson_interval
from parser_service.analysis.arrays import Floats, Ints
from parser_service.analysis.intervals import SAMPLES, SEED

Interval: TypeAlias = tuple[float, float]
Tally: TypeAlias = "Mapping[Hashable, tuple[float, float]]"
"""Cluster → the number of its examples that are right, and of all of them."""


def folds_of(clusters: Iterable[str], folds: int) -> dict[str, int]:
    """Return cluster → its fold, from 0, all folds with as many clusters (the first ones with one more).

    The order is that of their SHA-256, so that it depends on nothing but the clusters. Where there is
    a single one there is nothing to fit on besides it, and no fold.
    """
    ordered = sorted(set(clusters), key=lambda each: (sha256(each.encode()).digest(), each))
    return {each: at % folds for at, each in enumerate(ordered)} if len(ordered) > 1 else {}


@dataclass(frozen=True, eq=False, slots=True)
class Clustered:
    """How often some trainings of one parser are right, by cluster.

    ``right`` and ``count`` [trainings, clusters] are numbers of examples; a training that was tested
    without a cluster has a count of 0 there.
    """

    names: tuple[Hashable, ...]
    right: Floats
    count: Floats

    @classmethod
    def of(cls, tallies: Sequence[Tally]) -> Clustered:
        """Put one tally for each training together. Raises ValueError where one has no example."""
        if not tallies or not all(sum(count for _, count in each.values()) for each in tallies):
            raise ValueError("There is no example to count.")
        names = tuple(sorted({name for each in tallies for name in each}, key=str))
        rows = np.array(
            [[each.get(name, (0, 0)) for name in names] for each in tallies], dtype=float
        )
        return cls(names, rows[..., 0], rows[..., 1])

    @property
    def clusters(self) -> int:
        return len(self.names)

    @property
    def accuracies(self) -> Floats:
        """Fractions of 1, [trainings]."""
        return np.asarray(self.right.sum(1) / self.count.sum(1))

    def over(self, names: Sequence[Hashable]) -> Clustered:
        """Return these counts over the clusters ``names``; those that it lacks have no example."""
        place = {name: at for at, name in enumerate(self.names)}
        at = [place.get(name, -1) for name in names]  # the last column is one of zeros
        right, count = (np.pad(each, ((0, 0), (0, 1)))[:, at] for each in (self.right, self.count))
        return Clustered(tuple(names), right, count)


Parts: TypeAlias = "tuple[Clustered] | tuple[Clustered, Clustered]"
"""What a figure is made of: one part of a split, whose accuracy it is, or the unseen and the known forms,
whose harmonic mean it is. The trainings of both are the same, in the same order."""


class _Numbers:
    """Parts that compare equal by their numbers, whatever their clusters are called. Caches are keyed by them,
    since a page shows the same figures again and again."""

    def __init__(self, parts: Sequence[Clustered]) -> None:
        self.parts = parts
        self._key = tuple(
            (part.right.shape, part.right.tobytes(), part.count.tobytes()) for part in parts
        )
        self._hash = hash(self._key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Numbers) and self._key == other._key

    def __hash__(self) -> int:
        return self._hash


def figures_of(parts: Sequence[Clustered]) -> Floats:
    """Return the figure of each training, a fraction of 1, [trainings]."""
    return _combine([part.accuracies for part in parts])


def interval_of(parts: Parts, samples: int = SAMPLES) -> Interval:
    """Return the 95 % interval of the mean figure over the trainings, fractions of 1.

    The 2.5th and 97.5th percentile under resampling of clusters and trainings. Where every cluster is
    right, or every one wrong, or there is one alone, samples do not differ: then it is Wilson's interval over
    the clusters.
    """
    return _interval_of(_Numbers(parts), samples)


@lru_cache(maxsize=1024)
def _interval_of(numbers: _Numbers, samples: int) -> Interval:
    parts = numbers.parts
    if any(_is_flat(part) for part in parts):
        ends = np.array([_ends(part, samples) for part in parts])  # [parts, low and high]
        low, high = _combine(list(ends))
    else:
        low, high = np.percentile(_sample(parts, samples), [2.5, 97.5])
    return float(low), float(high)


def compare(first: Parts, second: Parts, samples: int = SAMPLES) -> tuple[Interval, float]:
    """Return the 95 % interval of the mean figure of ``first`` less that of ``second``, and its two-sided
    p-value, by a paired bootstrap: both are drawn with the same clusters.

    The p-value is the level at which the percentile interval would just reach 0, and never below the
    least of a sign test over the clusters in which they differ: few of them say less than samples do.
    """
    names = [
        sorted({*one.names, *other.names}, key=str)
        for one, other in zip(first, second, strict=True)
    ]
    aligned = (
        _Numbers([part.over(each) for part, each in zip(parts, names, strict=True)])
        for parts in (first, second)
    )
    return _compare(*aligned, samples)


@lru_cache(maxsize=1024)
def _compare(first: _Numbers, second: _Numbers, samples: int) -> tuple[Interval, float]:
    differences = _sample(first.parts, samples) - _sample(second.parts, samples, stream=1)
    low, high = np.percentile(differences, [2.5, 97.5])
    differing = 0  # the clusters in which the two parsers differ, over all trainings
    for parts in zip(first.parts, second.parts, strict=True):
        shares = [part.right.sum(0) / np.maximum(part.count.sum(0), 1) for part in parts]
        differing += int((~np.isclose(*shares)).sum())
    return (float(low), float(high)), float(p_values(differences, differing))


def p_values(differences: Floats, differing: ArrayLike) -> Floats:
    """Return the two-sided p-values of differences in samples, […, samples], between what differs in that many
    clusters, […].

    No p-value is below the least that a sign test over these clusters can have, 2^(1 − differing).
    """
    # The data itself counts as one sample, so that p is never 0 (Davison and Hinkley 1997, p. 141).
    tails = np.minimum((differences <= 0).sum(-1), (differences >= 0).sum(-1))
    least = 2.0 ** (1 - np.asarray(differing, dtype=float))
    return np.asarray(
        np.minimum(1.0, np.maximum(2 * (1 + tails) / (1 + differences.shape[-1]), least))
    )


def accuracies_in_samples(right: Ints, count: Ints, samples: int = SAMPLES) -> Floats:
    """Return the accuracy of each of several runs in each sample of clusters, all drawn alike.

    Args:
        right: the number of examples that a run has right in each cluster, [runs, …, clusters].
        count: the number of examples in each cluster, at least one in all, […, clusters].

    Returns:
        Fractions of 1 in single precision, [runs, …, samples]; a sample without an example has the accuracy
        of all.
    """
    drawn = _draws(count.shape[-1], 0, samples).T
    rows = np.concatenate([count[None], right]).astype(np.float32)  # [1 + runs, …, clusters]
    sums = rows.reshape(-1, rows.shape[-1]) @ drawn  # one product of matrices is the quickest
    counts, *rights = sums.reshape(*rows.shape[:-1], samples)
    accuracies = np.array(rights) / np.maximum(counts, 1)
    if (counts == 0).any():
        overall = (right.sum(-1) / count.sum(-1))[..., None]
        accuracies = np.where(counts > 0, accuracies, overall.astype(np.float32))
    return np.asarray(accuracies)


def _sample(parts: Sequence[Clustered], samples: int, stream: int = 0) -> Floats:
    """Return the mean figure in each sample, [samples]. Clusters are drawn alike for every ``stream``, the
    trainings of different ones independently."""
    figures = _combine([_accuracies(part, at, samples) for at, part in enumerate(parts)])
    trainings = figures.shape[1]
    weights = _draws(trainings, len(parts) + stream, samples) if trainings > 1 else 1.0
    # A training has no figure in a sample with none of its clusters.
    weighted = np.where(np.isnan(figures), 0.0, weights)
    total = weighted.sum(1)
    mean = (weighted * np.nan_to_num(figures)).sum(1) / np.maximum(total, 1e-9)
    overall = float(figures_of(parts).mean())
    return np.where(total > 0, mean, overall)


def _accuracies(part: Clustered, stream: int, samples: int) -> Floats:
    """Return the accuracy of each training in each sample, [samples, trainings]; NaN without an example."""
    both = np.concatenate([part.right, part.count]).astype(np.float32)  # [2 · trainings, clusters]
    sums = (_draws(part.clusters, stream, samples) @ both.T).astype(float)
    right, count = np.split(sums, 2, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(right / count)


@lru_cache(maxsize=8)
def _draws(number: int, stream: int, samples: int) -> Floats:
    """Return how often each of ``number`` things is in each sample, [samples, number]. Single precision, in
    which counts are exact, since a page keeps some of these."""
    random = np.random.default_rng([SEED, stream, number])
    drawn = random.multinomial(number, np.full(number, 1 / number), size=samples)
    return drawn.astype(np.float32)


def _combine(accuracies: Sequence[Floats]) -> Floats:
    """Return accuracies themselves, or the harmonic mean of two, which is 0 where either is."""
    if len(accuracies) == 1:
        return accuracies[0]
    one, other = accuracies
    total = one + other
    return np.asarray(2 * one * other / np.where(total > 0, total, 1.0))


def _ends(part: Clustered, samples: int) -> Interval:
    if _is_flat(part):
        share = float(part.accuracies.mean())
        return wilson_interval(share * part.clusters, part.clusters)
    low, high = np.percentile(_sample((part,), samples), [2.5, 97.5])
    return float(low), float(high)


def _is_flat(part: Clustered) -> bool:
    """Return whether samples of clusters do not differ."""
    accuracies = set(part.accuracies)
    return part.clusters == 1 or accuracies <= {0.0} or accuracies <= {1.0}
