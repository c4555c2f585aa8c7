"""Find unexpected defaults: forms that a parser gives to utterances which have nothing in common."""

from __future__ import annotations

from parser_service.analysis.attractors.dispersion import (
    compare_dispersion,
    mean_distance,
    unit_vectors,
)
from parser_service.analysis.attractors.finding import LEVEL, Attractor, find_attractors

__all__ = [
    "LEVEL",
    "Attractor",
    "compare_dispersion",
    "find_attractors",
    "mean_distance",
    "unit_vectors",
]
