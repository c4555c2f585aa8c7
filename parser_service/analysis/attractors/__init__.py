"""Find unexpected defaults: forms that a parser gives to utterances which have nothing in common."""

from __future__ import annotations

from parser_service.analysis.attractors.finding import Attractor, find_attractors

__all__ = [
    "Attractor",
    "find_attractors",
]
