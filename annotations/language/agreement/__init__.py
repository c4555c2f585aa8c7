"""Measure how well people agree: exact match, Krippendorff's α and Gwet's AC1, with intervals."""

from __future__ import annotations

from annotations.language.agreement.estimates import (
    Agreement,
    Distances,
    alpha,
    exact_match,
    gwet_ac1,
    measure,
)
from annotations.language.agreement.ratings import read_ratings

__all__ = [
    "Agreement",
    "Distances",
    "alpha",
    "exact_match",
    "gwet_ac1",
    "measure",
    "read_ratings",
]
