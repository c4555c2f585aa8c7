"""Is one run better than another, or was it luck? Paired tests over the same examples.

Only examples on which the two runs differ matter: ``wins`` where the first alone is right, ``losses``
where the second alone is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from parser_service.analysis.arrays import Floats
from parser_service.analysis.resampling import SEED, multinomial_samples

SAMPLES = 10_000


def paired_bootstrap(
    wins: int, losses: int, count: int, seed: int = SEED, samples: int = SAMPLES
) -> tuple[tuple[float, float], float]:
    """Return the 95 % interval of the difference in accuracy, and the two-sided p-value.

    The difference is (wins − losses) / count, a fraction of 1. Resampling the examples is drawing their
    three outcomes from a multinomial, which makes the cost independent of ``count``. The p-value is
    the level at which the percentile interval would just reach 0. (Efron and Tibshirani, An Introduction
    to the Bootstrap, 1993; Koehn, Statistical significance tests for machine translation evaluation, 2004.)

    Raises:
        ValueError: there is no example.
    """
    if count < 1:
        raise ValueError("There is no example to compare runs on.")
    outcomes = np.array([wins, losses, count - wins - losses])
    drawn = multinomial_samples(outcomes, samples, np.random.default_rng(seed))
    differences = drawn[:, 0] - drawn[:, 1]  # [samples]
    low, high = np.percentile(differences, [2.5, 97.5]) / count
    # The data itself counts as one sample, so that p is never 0 (Davison and Hinkley 1997, p. 141).
    tails = np.array([(differences <= 0).sum(), (differences >= 0).sum()])
    p_value = min(1.0, 2 * (1 + int(tails.min())) / (1 + samples))
    return (float(low), float(high)), p_value


def mcnemar(wins: ArrayLike, losses: ArrayLike) -> Floats:
    """Return the two-sided p-values of McNemar's exact test (Psychometrika 12, 1947), any shape.

    It is the binomial test that a win is as likely as a loss; 1 where there is neither.
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
