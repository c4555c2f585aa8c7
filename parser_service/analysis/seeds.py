"""One accuracy out of several: the same parser, trained with other seeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import fmean, stdev


@dataclass(frozen=True, slots=True)
class OverSeeds:
    """``mean`` and ``spread`` of ``n_seeds`` accuracies, fractions of 1.

    ``spread`` is the sample standard deviation (divisor n - 1), None of a single one.
    """

    mean: float
    spread: float | None
    n_seeds: int


def over_seeds(accuracies: Sequence[float]) -> OverSeeds:
    """Mean and spread of one accuracy a seed. Raises ValueError where there is none."""
    if not accuracies:
        raise ValueError("There is no seed to take a mean over.")
    spread = stdev(accuracies) if len(accuracies) > 1 else None
    return OverSeeds(fmean(accuracies), spread, len(accuracies))
