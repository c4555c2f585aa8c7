"""Wilson's 95 % interval of a proportion.

Wilson, Probable inference, the law of succession, and statistical inference, Journal of the American
Statistical Association 22, 1927. Unlike the usual ± it is also right near 0 and 1 and for few examples.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Z_95 = 1.959963984540054


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
