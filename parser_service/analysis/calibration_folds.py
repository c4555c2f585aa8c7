"""Two folds of what is right or wrong together, so that nothing is scored by what it calibrated."""

from __future__ import annotations

from collections.abc import Iterable
from hashlib import sha256

FOLDS = 2


def folds_of(clusters: Iterable[str]) -> dict[str, int]:
    """Return cluster → its fold, 0 or 1, each with half of the clusters (one more in fold 0 where they are odd).

    The order is that of their SHA-256, so that it depends on nothing but the clusters. Where there is
    a single one there is nothing to calibrate on, and no fold.
    """
    ordered = sorted(set(clusters), key=lambda each: (sha256(each.encode()).digest(), each))
    return {each: at % FOLDS for at, each in enumerate(ordered)} if len(ordered) > 1 else {}
