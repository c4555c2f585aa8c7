"""95 % intervals of a share: Wilson's of a proportion, and a bootstrap's of a ratio.

Wilson, Probable inference, the law of succession, and statistical inference, Journal of the American
Statistical Association 22, 1927. Unlike the usual ± it is also right near 0 and 1 and for few examples.

The bootstrap costs the same for a thousand examples and for a million: a sample with replacement is known from
how often it has each *distinct* example, and these counts are multinomial. Percentile intervals: Efron and
Tibshirani, An Introduction to the Bootstrap, 1993.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from parser_service.analysis.arrays import Floats, Ints

Z_95 = 1.959963984540054
SAMPLES = 2000
SEED = 2019
_DECIMALS = 6  # sums that agree to so many places count as the same example
_MOST_KINDS = 1000  # distinct examples that are resampled


def wilson_interval(correct: float, count: float) -> tuple[float, float]:
    """Return the 95 % interval of ``correct`` out of ``count``, at least 1. Both ends are in 0–1."""
    low, high = wilson_intervals(correct, count)
    return float(low), float(high)


def wilson_intervals(correct: ArrayLike, count: ArrayLike) -> tuple[Floats, Floats]:
    """Return the lower and the upper ends of the 95 % intervals.

    Args:
        correct: numbers of successes, any shape.
        count: numbers of trials, a shape that broadcasts with it; where 0, both ends are NaN.
    """
    trials = np.asarray(count, dtype=float)
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.asarray(correct, dtype=float) / trials
        spread = Z_95**2 / trials
        centre = share + spread / 2
        reach = np.sqrt(spread * (share * (1 - share) + spread / 4))
        low, high = (centre - reach) / (1 + spread), (centre + reach) / (1 + spread)
    return np.maximum(0.0, low), np.minimum(1.0, high)


def multinomial_samples(counts: Ints, samples: int, random: np.random.Generator) -> Ints:
    """Return how often each of the distinct examples is in each sample, [samples, distinct]."""
    return random.multinomial(int(counts.sum()), counts / counts.sum(), size=samples)


def ratio_interval(
    numerators: Floats, denominators: Floats, seed: int = SEED, samples: int = SAMPLES
) -> tuple[float, float] | None:
    """Return the 95 % interval of Σ numerators / Σ denominators under resampling of examples.

    Args:
        numerators: one number per example, in 0 to its denominator: [examples].
        denominators: what each counts for, above 0: [examples].

    Returns:
        The 2.5th and 97.5th percentile. Where every ratio is 0, or every one is 1, samples do not
        differ, and it is Wilson's interval over the examples; where very many examples are distinct,
        it is the limit that percentiles approach. None without an example.
    """
    if not len(numerators):
        return None
    total, weight = float(numerators.sum()), float(denominators.sum())
    if total in (0.0, weight):
        return wilson_interval(len(numerators) if total else 0, len(numerators))
    pairs = (
        np.round(numerators, _DECIMALS) + 1j * denominators
    )  # complex numbers are sorted at once
    kinds, counts = np.unique(pairs, return_counts=True)
    if len(kinds) > _MOST_KINDS:
        # The normal interval of a ratio (Cochran, Sampling Techniques, 3rd edition 1977, §2.11).
        ratio = numerators.sum() / denominators.sum()
        error = np.sqrt(((numerators - ratio * denominators) ** 2).sum()) / denominators.sum()
        return max(0.0, float(ratio - Z_95 * error)), min(1.0, float(ratio + Z_95 * error))
    drawn = multinomial_samples(counts, samples, np.random.default_rng(seed)) @ kinds
    low, high = np.percentile(drawn.real / drawn.imag, [2.5, 97.5])
    return float(low), float(high)
