"""Measure how well people agree: exact match, Krippendorff's α and Gwet's AC1, with intervals."""

from __future__ import annotations

from annotations.language.agreement.estimates import Agreement, Distances, measure

__all__ = [
    "Agreement",
    "Distances",
    "measure",
]
