"""The 95 % interval of a ratio, by a bootstrap.

The bootstrap costs the same for a thousand examples and for a million: a sample with replacement is known from
how often it has each *distinct* example, and these counts are multinomial. Percentile intervals: Efron and
Tibshirani, An Introduction to the Bootstrap, 1993.
"""

from __future__ import annotations

import numpy as np

from annotations.language.corpus import Z_95, wilson_interval
from parser_service.analysis.arrays import Floats, Ints

SAMPLES = 2000
SEED = 2019
_DECIMALS = 6  # sums that agree to so many places count as the same example
_MOST_KINDS = 1000  # distinct examples that are resampled


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
    # Complex numbers are sorted at once.
    pairs = np.round(numerators, _DECIMALS) + 1j * denominators
    kinds, counts = np.unique(pairs, return_counts=True)
    if len(kinds) > _MOST_KINDS:
        return _limit(numerators, denominators)
    drawn = multinomial_samples(counts, samples, np.random.default_rng(seed)) @ kinds
    low, high = np.percentile(drawn.real / drawn.imag, [2.5, 97.5])
    return float(low), float(high)


def _limit(numerators: Floats, denominators: Floats) -> tuple[float, float]:
    """Return the normal interval of a ratio (Cochran, Sampling Techniques, 3rd edition 1977, §2.11)."""
    ratio = numerators.sum() / denominators.sum()
    error = np.sqrt(((numerators - ratio * denominators) ** 2).sum()) / denominators.sum()
    return max(0.0, float(ratio - Z_95 * error)), min(1.0, float(ratio + Z_95 * error))
