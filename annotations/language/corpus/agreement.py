"""Measure how well people agree: exact match, Krippendorff's α and Gwet's AC1, with intervals.

Each coefficient comes with its 95 % interval and a sentence that says what it means. Intervals of α and
AC1 are percentiles of a bootstrap over items (Efron and Tibshirani, An Introduction to the Bootstrap,
1993), with a fixed seed; that of exact match is Wilson's.

``weights`` says how often each item is in each sample, [samples, items]; ones for the data itself.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from annotations.language.corpus.proportions import wilson_interval

SAMPLES = 1000
SEED = 2019
# Krippendorff, Content Analysis (2004), p. 241: from here on conclusions are reliable, or tentative.
RELIABLE, TENTATIVE = 0.8, 2 / 3
FEW_ITEMS = 30  # fewer get a word of caution
FEWEST_ITEMS = 5  # for an interval

Distances = Callable[[Sequence[Hashable]], Sequence[Sequence[float]]]
Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Estimate:
    """``value`` is None where the ratings do not define it; ``meaning`` says why. ``interval`` is None
    then too, and for very few items."""

    value: float | None
    interval: tuple[float, float] | None
    meaning: str


@dataclass(frozen=True, slots=True)
class Agreement:
    """How well people agree on ``items`` that at least two of them rated."""

    items: int
    exact_match: Estimate
    alpha: Estimate
    ac1: Estimate


def measure(items: Sequence[Sequence[Hashable]], distances: Distances | None = None) -> Agreement:
    """Return every coefficient for the values that people gave to each item.

    ``distances`` gives the distances between values, [values, values], each from 0 to 1; without it
    two values are equal or not.
    """
    ratings = read_ratings(items)
    return Agreement(
        ratings.items, exact_match(ratings), alpha(ratings, distances), gwet_ac1(ratings)
    )


def exact_match(ratings: Ratings) -> Estimate:
    """Return the share of equal pairs of ratings, averaged over items."""
    if not ratings.items:
        return _nothing()
    share = float(observed_agreement(ratings, _once(ratings))[0])
    interval = wilson_interval(share * ratings.items, ratings.items)
    noun = "item" if ratings.items == 1 else "items"
    meaning = f"Two people give the same form to {100 * share:.0f} % of {ratings.items:,} {noun}."
    return Estimate(share, interval, meaning + _caution(ratings))


def alpha(ratings: Ratings, distances: Distances | None = None) -> Estimate:
    """Return Krippendorff's α: 1 without disagreement, 0 where people agree as chance does."""
    if not ratings.items:
        return _nothing()
    if distances is None:
        differences = 1 - np.eye(len(ratings.values))
    else:
        differences = np.array(distances(ratings.values), dtype=float)

    def coefficient(weights: Array) -> Array:
        return alpha_values(ratings, differences, weights)

    value = float(coefficient(_once(ratings))[0])
    if np.isnan(value):
        return Estimate(
            None, None, "Every label is the same, so that α has nothing to measure. Label more."
        )
    interval = _bootstrap(coefficient, ratings)
    low = interval[0] if interval else -1.0
    if low >= RELIABLE:
        meaning = f"The labels are reliable: α is above {RELIABLE:.2f} throughout its interval."
    elif low >= TENTATIVE:
        meaning = (
            f"The labels allow tentative conclusions: α may be below {RELIABLE:.2f}, but is above "
            f"{TENTATIVE:.2f}."
        )
    else:
        meaning = (
            f"The labels are not known to be reliable: α may be below {TENTATIVE:.2f}. Read the most "
            "frequent disagreements, agree on a rule for each and label again."
        )
    return Estimate(value, interval, meaning + _caution(ratings))


def gwet_ac1(ratings: Ratings) -> Estimate:
    """Return Gwet's AC1, which stays meaningful where nearly all ratings are equal."""
    if not ratings.items:
        return _nothing()
    value = float(ac1_values(ratings, _once(ratings))[0])
    chance = float(chance_agreement(ratings, _once(ratings))[0])
    interval = _bootstrap(lambda weights: ac1_values(ratings, weights), ratings)
    meaning = (
        f"Chance would make people agree on {100 * chance:.0f} % of the items; they reach "
        f"{100 * max(value, 0):.0f} % of the way from there to full agreement."
    )
    return Estimate(value, interval, meaning + _caution(ratings))


def _caution(ratings: Ratings) -> str:
    is_small = ratings.items < FEW_ITEMS
    return f" With fewer than {FEW_ITEMS} items this says little yet." if is_small else ""


def _nothing() -> Estimate:
    return Estimate(None, None, "No item has been labelled by two people yet.")


def _once(ratings: Ratings) -> Array:
    return np.ones((1, ratings.items))


def _bootstrap(
    coefficient: Callable[[Array], Array], ratings: Ratings
) -> tuple[float, float] | None:
    """Return the 2.5th and 97.5th percentile over samples of items drawn with replacement.

    None for so few items that samples say nothing.
    """
    if ratings.items < FEWEST_ITEMS:
        return None
    random = np.random.default_rng(SEED)
    share = np.full(ratings.items, 1 / ratings.items)
    weights = random.multinomial(ratings.items, share, size=SAMPLES).astype(float)
    values = coefficient(weights)
    low, high = np.percentile(values[~np.isnan(values)], [2.5, 97.5])
    return float(low), float(high)


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
