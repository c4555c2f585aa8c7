"""Accuracy of every run within every slice of the examples."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from parser_service.analysis.arrays import Bools, Floats, Ints
from parser_service.analysis.labels import Labels, encode
from parser_service.analysis.proportions import wilson_intervals


@dataclass(frozen=True, eq=False, slots=True)
class SliceAccuracies:
    """Slice ``values[s]`` has ``counts[s]`` examples, of which run r has ``correct[r, s]`` right.

    ``low`` and ``high`` are the ends of Wilson's 95 % interval of the accuracy, [runs, slices]. An empty
    slice has NaN for all three.
    """

    values: tuple[Hashable, ...]
    counts: Ints  # [slices]
    correct: Ints  # [runs, slices]
    low: Floats
    high: Floats

    @property
    def accuracies(self) -> Floats:
        """Fractions of 1, [runs, slices]."""
        with np.errstate(invalid="ignore"):
            return self.correct / self.counts


def accuracy_by(
    correct: Bools, labels: Sequence[Hashable], values: Sequence[Hashable] = ()
) -> SliceAccuracies:
    """Return the accuracy of each run in each slice.

    Args:
        correct: whether each run is right on each example, [runs, examples].
        labels: the slice of each example, [examples].
        values: slices to list first, in this order, even where empty; the others follow in the
            order of their first appearance.

    Raises:
        ValueError: there are not as many labels as examples.
    """
    return accuracy_of_labels(correct, encode(labels, values))


def accuracy_of_labels(correct: Bools, labels: Labels[Any]) -> SliceAccuracies:
    """Return the same for labels that are encoded already. Raises likewise."""
    _require_same_length(correct, len(labels.codes))
    size = len(labels.values)
    right = [np.bincount(labels.codes[run], minlength=size) for run in correct]
    return _summarize(labels.values, labels.counts(), np.array(right).reshape(-1, size))


def accuracy_where(correct: Bools, mask: Bools) -> SliceAccuracies:
    """Return the accuracy of each run on the examples of a mask, [examples]: one slice, called True.

    Raises:
        ValueError: the mask does not have the length of the examples.
    """
    _require_same_length(correct, len(mask))
    right = np.count_nonzero(correct & mask, axis=1, keepdims=True)
    return _summarize((True,), np.array([np.count_nonzero(mask)]), right)


def _require_same_length(correct: Bools, length: int) -> None:
    if correct.shape[1] != length:
        raise ValueError(f"{length} labels do not fit {correct.shape[1]} examples.")


def _summarize(values: tuple[Hashable, ...], counts: Ints, correct: Ints) -> SliceAccuracies:
    low, high = wilson_intervals(correct, counts)
    return SliceAccuracies(values, counts, correct, low, high)
