"""How far a paraphrase is from the command that it rewrites (docs/reference/formats.md, Triples)."""

from __future__ import annotations

import re
from dataclasses import dataclass

from rapidfuzz.distance import Levenshtein

_SEPARATORS = re.compile(r"[\s,]+")


@dataclass(frozen=True, slots=True)
class Distance:
    """``edit`` in characters, ``jaccard`` in 0–1."""

    edit: int
    jaccard: float


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
    return Distance(levenshtein(paraphrase, original), jaccard(paraphrase, original))
