"""Frozen copies of the corpus, from which parsers learn and by which they are scored."""

from __future__ import annotations

from annotations.models.splits.splits import (
    Criterion,
    Example,
    Part,
    Source,
    Split,
    criterion_choices,
    part_choices,
    shape_of,
    source_choices,
)

__all__ = [
    "Criterion",
    "Example",
    "Part",
    "Source",
    "Split",
    "criterion_choices",
    "part_choices",
    "shape_of",
    "source_choices",
]
