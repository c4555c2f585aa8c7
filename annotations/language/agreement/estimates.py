"""Coefficients of agreement with their 95 % intervals and a sentence that says what each means.

Intervals of α and AC1 are percentiles of a bootstrap over items (Efron and Tibshirani, An Introduction
to the Bootstrap, 1993), with a fixed seed; that of exact match is Wilson's.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass

import numpy as np

from annotations.language.agreement.ratings import (
    Array,
    Ratings,
    ac1_values,
    alpha_values,
    chance_agreement,
    observed_agreement,
    read_ratings,
)

SAMPLES = 1000
SEED = 2019
Z_95 = 1.959963984540054
# Krippendorff, Content Analysis (2004), p. 241: from here on conclusions are reliable, or tentative.
RELIABLE, TENTATIVE = 0.8, 2 / 3
FEW_ITEMS = 30  # fewer get a word of caution
FEWEST_ITEMS = 5  # for an interval

Distances = Callable[[Sequence[Hashable]], Sequence[Sequence[float]]]


@dataclass(frozen=True, slots=True)
class Estimate:
    """``value`` is None where the ratings do not define it; ``meaning`` says why. ``interval`` is None with
    it, and where there are very few items."""

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
    interval = _wilson(share, ratings.items)
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
    meaning = _meaning_of_alpha(interval[0] if interval else -1.0)
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


def _meaning_of_alpha(low: float) -> str:
    """Say what the lower end of the interval allows one to conclude."""
    if low >= RELIABLE:
        return f"The labels are reliable: α is above {RELIABLE:.2f} throughout its interval."
    if low >= TENTATIVE:
        return (
            f"The labels allow tentative conclusions: α may be below {RELIABLE:.2f}, but is above "
            f"{TENTATIVE:.2f}."
        )
    return (
        f"The labels are not known to be reliable: α may be below {TENTATIVE:.2f}. Read the most "
        "frequent disagreements, agree on a rule for each and label again."
    )


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

    None for very few items, of which samples say nothing.
    """
    if ratings.items < FEWEST_ITEMS:
        return None
    random = np.random.default_rng(SEED)
    share = np.full(ratings.items, 1 / ratings.items)
    weights = random.multinomial(ratings.items, share, size=SAMPLES).astype(float)
    values = coefficient(weights)
    low, high = np.percentile(values[~np.isnan(values)], [2.5, 97.5])
    return float(low), float(high)


def _wilson(share: float, count: int) -> tuple[float, float]:
    """Return Wilson's interval (Journal of the American Statistical Association 22, 1927)."""
    square = Z_95**2 / count
    middle = (share + square / 2) / (1 + square)
    half = Z_95 * np.sqrt(share * (1 - share) / count + square / (4 * count)) / (1 + square)
    return max(0.0, float(middle - half)), min(1.0, float(middle + half))
