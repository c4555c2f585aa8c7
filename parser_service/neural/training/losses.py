"""The loss of an epoch."""

from __future__ import annotations

import math
from collections.abc import Sequence


def finite_mean(losses: Sequence[float], epoch: int, learning_rate: float) -> float:
    """Return the mean loss of ``epoch``. Raises ValueError, a sentence, where it is not finite."""
    mean = sum(losses) / len(losses)
    if not math.isfinite(mean):
        raise ValueError(
            f"Training diverged in epoch {epoch}: the loss is {mean}. "
            f"Try a learning rate below {learning_rate:g}."
        )
    return mean
