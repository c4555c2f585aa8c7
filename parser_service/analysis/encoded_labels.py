"""Labels as small integers, so that a million of them can be counted at once."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from parser_service.analysis.arrays import Ints

Label = TypeVar("Label", bound=Hashable)


@dataclass(frozen=True, eq=False, slots=True)
class EncodedLabels(Generic[Label]):
    """``values`` are distinct; ``codes`` [examples] says which of them each example has."""

    values: tuple[Label, ...]
    codes: Ints

    def counts(self) -> Ints:
        """Return how many examples have each value, [values]."""
        return np.bincount(self.codes, minlength=len(self.values))


def encode(labels: Sequence[Label], values: Sequence[Label] = ()) -> EncodedLabels[Label]:
    """Return the labels as codes. Values come in the order given, then of their first appearance."""
    places = {value: code for code, value in enumerate(dict.fromkeys((*values, *labels)))}
    codes = np.fromiter(map(places.__getitem__, labels), dtype=np.int64, count=len(labels))
    return EncodedLabels(tuple(places), codes)


def distinct_pairs(first: Ints, second: Ints) -> tuple[Ints, Ints, Ints]:
    """Return the distinct pairs of codes, first and second part, and how often each occurs: [pairs] each.

    Pairs are in ascending order. Codes are not negative.
    """
    width = int(second.max(initial=0)) + 1
    pairs, counts = np.unique(first * width + second, return_counts=True)
    return pairs // width, pairs % width, counts
