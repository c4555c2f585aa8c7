"""How far a paraphrase is from the command that it rewrites (FORMATS §6, §7)."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum

from rapidfuzz.distance import Levenshtein

# Thresholds of the published task.
CLOSE_EDIT, FAR_EDIT = 0.15, 1.0
CLOSE_WORDS, FAR_WORDS = 0.2, 0.9
_SEPARATORS = re.compile(r"[\s,]+")


class Closeness(StrEnum):
    """Whether a paraphrase deserves a warning."""

    TOO_CLOSE = "too close"
    FINE = "fine"
    TOO_FAR = "too far"


@dataclass(frozen=True, slots=True)
class Distance:
    """``edit`` in characters, ``relative_edit`` per character of the original, ``jaccard`` in 0–1."""

    edit: int
    relative_edit: float
    jaccard: float

    @property
    def closeness(self) -> Closeness:
        """Too close if either distance is below its threshold, else too far if one is above."""
        if self.relative_edit < CLOSE_EDIT or self.jaccard < CLOSE_WORDS:
            return Closeness.TOO_CLOSE
        if self.relative_edit > FAR_EDIT or self.jaccard > FAR_WORDS:
            return Closeness.TOO_FAR
        return Closeness.FINE


def words(text: str) -> frozenset[str]:
    """Return the lower-cased words of a text, split on spaces and commas."""
    return frozenset(_SEPARATORS.split(text.lower())) - {""}


def levenshtein(first: str, second: str) -> int:
    """Count insertions, deletions and substitutions of characters, case-sensitive (Levenshtein 1966)."""
    return Levenshtein.distance(first, second)


def jaccard(first: str, second: str) -> float:
    """Return 1 − shared ``words`` / all words (Jaccard 1912); 0 for two texts without words."""
    left, right = words(first), words(second)
    union = left | right
    return 1 - len(left & right) / len(union) if union else 0.0


def distance(paraphrase: str, original: str) -> Distance:
    """Return every distance between a paraphrase and its original."""
    edit = levenshtein(paraphrase, original)
    return Distance(edit, edit / max(len(original), 1), jaccard(paraphrase, original))
