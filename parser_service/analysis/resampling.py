"""Bootstrap intervals that cost the same for a thousand examples and for a million.

A sample with replacement is known from how often it has each *distinct* example, and these counts are
multinomial. Percentile intervals: Efron and Tibshirani, An Introduction to the Bootstrap, 1993.
"""

from __future__ import annotations

import numpy as np

from parser_service.analysis.arrays import Floats, Ints
from parser_service.analysis.proportions import wilson_interval

SAMPLES = 2000
SEED = 2019
_DECIMALS = 6  # sums that agree to so many places count as the same example
_MOST_AT_ONCE = 4_000_000  # counts held in memory


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
        differ, and it is Wilson's interval over the examples. None without an example.
    """
    if not len(numerators):
        return None
    total, weight = float(numerators.sum()), float(denominators.sum())
    if total in (0.0, weight):
        return wilson_interval(len(numerators) if total else 0, len(numerators))
    rows = np.round(np.column_stack([numerators, denominators]), _DECIMALS)
    kinds, counts = np.unique(rows, axis=0, return_counts=True)
    random = np.random.default_rng(seed)
    step = max(1, _MOST_AT_ONCE // len(kinds))
    sums = [
        multinomial_samples(counts, min(step, samples - start), random) @ kinds
        for start in range(0, samples, step)
    ]
    ratios = np.concatenate(sums)
    low, high = np.percentile(ratios[:, 0] / ratios[:, 1], [2.5, 97.5])
    return float(low), float(high)
