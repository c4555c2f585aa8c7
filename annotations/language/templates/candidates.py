"""What the modules that suggest repairs share: a candidate, and edits of the two sides."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from rapidfuzz.distance import OSA

from annotations.language.texts import Repair, TextEdit

PATTERN, FORM = "pattern", "form"
MOST_UNLIKE = 0.6  # names that differ more are not offered for one another


@dataclass(frozen=True, slots=True)
class RepairCandidate:
    """A repair that has not been tried; the lowest ``rank`` is the most likely among equally good ones."""

    repair: Repair
    rank: float = 0.0


def candidate(label: str, edits: Iterable[TextEdit], rank: float = 0.0) -> RepairCandidate:
    """Return a candidate that is called ``label``."""
    return RepairCandidate(Repair(label, tuple(edits)), rank)


def insert(source: str, at: int, text: str) -> TextEdit:
    """Return the edit that puts ``text`` before the character at ``at``."""
    return TextEdit(source, at, at, text)


def distance(name: str, other: str) -> float:
    """Return how much two names differ, from 0 to 1, whatever their case."""
    return OSA.normalized_distance(name.lower(), other.lower())


def nearest(name: str, names: Iterable[str], most: int = 6) -> list[tuple[str, float]]:
    """Return the names that are most like ``name``, each with its distance, nearest first."""
    near = ((each, distance(name, each)) for each in set(names) - {name})
    close = [(each, rank) for each, rank in near if rank <= MOST_UNLIKE]
    return sorted(close, key=lambda pair: (pair[1], pair[0]))[:most]


def shorten(text: str, longest: int = 30) -> str:
    """Return a text for a label, cut to ``longest`` characters."""
    return text if len(text) <= longest else f"{text[: longest - 1]}…"
