"""Ratings as counts, and the coefficients of agreement over samples of their items.

``weights`` says how often each item is in each sample, [samples, items]; ones for the data itself.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Ratings:
    """``counts`` says how many people gave each value to each item, [items, values].

    Every item has at least two ratings: what one person rated says nothing about agreement.
    """

    values: tuple[Hashable, ...]
    counts: Array

    @property
    def items(self) -> int:
        return len(self.counts)


def read_ratings(items: Sequence[Sequence[Hashable]]) -> Ratings:
    """Count the values given to each item; items with fewer than two are left out."""
    rated = [values for values in items if len(values) > 1]
    values = tuple(dict.fromkeys(value for row in rated for value in row))
    place = {value: number for number, value in enumerate(values)}
    counts = np.zeros((len(rated), len(values)))
    for number, row in enumerate(rated):
        for value in row:
            counts[number, place[value]] += 1
    return Ratings(values, counts)


def observed_agreement(ratings: Ratings, weights: Array) -> Array:
    """Return the share of pairs of ratings of one item that are equal, averaged over items: [samples]."""
    raters = ratings.counts.sum(axis=1)  # [items]
    equal = (ratings.counts * (ratings.counts - 1)).sum(axis=1) / (raters * (raters - 1))
    share: Array = weights @ equal / weights.sum(axis=1)
    return share


def ac1_values(ratings: Ratings, weights: Array) -> Array:
    """Return Gwet's AC1 (British Journal of Mathematical and Statistical Psychology 61, 2008): [samples].

    With a single value there is nothing to agree on by chance, and AC1 is 1.
    """
    observed = observed_agreement(ratings, weights)
    chance = chance_agreement(ratings, weights)
    return (observed - chance) / (1 - chance)


def chance_agreement(ratings: Ratings, weights: Array) -> Array:
    """Return the agreement that Gwet expects by chance: [samples]."""
    shares = ratings.counts / ratings.counts.sum(axis=1, keepdims=True)  # [items, values]
    prevalence = weights @ shares / weights.sum(axis=1, keepdims=True)  # [samples, values]
    spread: Array = (prevalence * (1 - prevalence)).sum(axis=1)
    return spread / max(len(ratings.values) - 1, 1)


def alpha_values(ratings: Ratings, differences: Array, weights: Array) -> Array:
    """Return Krippendorff's α (Computing Krippendorff's Alpha-Reliability, 2011): [samples].

    ``differences`` are δ² in his notation, [values, values]. A sample in which all ratings are equal
    has no α: it is NaN.
    """
    counts = ratings.counts
    raters = counts.sum(axis=1)  # [items]
    disagreement = ((counts @ differences) * counts).sum(axis=1) / (raters - 1)  # [items]
    total = weights @ raters  # [samples]
    totals = weights @ counts  # [samples, values]
    observed = weights @ disagreement / total
    expected = ((totals @ differences) * totals).sum(axis=1) / (total * (total - 1))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(expected > 0, 1 - observed / expected, np.nan)
