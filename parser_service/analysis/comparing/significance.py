"""McNemar's test, and several tests at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from parser_service.analysis.arrays import Floats

LEVEL = 0.05  # a corrected p-value up to this is called significant


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
