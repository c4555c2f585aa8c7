"""The accuracy of a parser over several seeds of its training."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import fmean, stdev


@dataclass(frozen=True, slots=True)
class OverSeeds:
    """``mean`` and ``spread`` of ``n_seeds`` accuracies, fractions of 1.

    ``spread`` is the sample standard deviation (divisor n - 1), None for a single seed.
    """

    mean: float
    spread: float | None
    n_seeds: int


def over_seeds(accuracies: Sequence[float]) -> OverSeeds:
    """Return mean and spread of one accuracy per seed. Raises ValueError where there is none."""
    if not accuracies:
        raise ValueError("There is no seed to take a mean over.")
    spread = stdev(accuracies) if len(accuracies) > 1 else None
    return OverSeeds(fmean(accuracies), spread, len(accuracies))
