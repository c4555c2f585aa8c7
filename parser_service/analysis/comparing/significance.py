"""Several tests at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from parser_service.analysis.arrays import Floats

LEVEL = 0.05  # a corrected p-value up to this is called significant


def holm(p_values: ArrayLike) -> Floats:
    """Return p-values corrected for the number of tests, [tests] (Holm, Scandinavian Journal of
    Statistics 6, 1979). Rejecting those up to 0.05 makes a single false finding at most 5 % likely."""
    p = np.asarray(p_values, dtype=float)
    order = np.argsort(p, kind="stable")
    factors = len(p) - np.arange(len(p))
    corrected = np.empty_like(p)
    corrected[order] = np.minimum(1.0, np.maximum.accumulate(p[order] * factors))
    return corrected
