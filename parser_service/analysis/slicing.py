"""Accuracy of runs on slices of a test part, and the values of an example that slices are made of."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

from annotations.language.corpus import wilson_intervals
from annotations.language.forms import head_predicate, read_or_none
from parser_service.analysis.answer_forms import NO_FORM
from parser_service.analysis.arrays import Bools, Floats, Ints
from parser_service.analysis.clustered import accuracies_in_samples, p_values
from parser_service.analysis.comparing import LEVEL, holm
from parser_service.analysis.encoded_labels import EncodedLabels, encode

SLICE_SAMPLES = 1_000  # a page has hundreds of intervals of slices
# Lengths at which a bin begins, in words; the published paraphrases have 2 to 34, the median is 9.
BIN_STARTS = (1, 5, 9, 13, 17)
Value = TypeVar("Value")


@dataclass(frozen=True, eq=False, slots=True)
class SliceAccuracies:
    """Slice ``values[s]`` has ``counts[s]`` examples, of which run r has ``correct[r, s]`` right.

    ``low`` and ``high`` are the ends of the 95 % interval of the accuracy, [runs, slices]: percentiles where whole
    clusters are drawn, or, where samples do not differ, Wilson's over the clusters. An empty slice has NaN
    for all three. ``is_best`` [runs, slices] marks the run that is better than each other one beyond chance,
    by a paired bootstrap of the same samples with Holm's correction.
    """

    values: tuple[Hashable, ...]
    counts: Ints  # [slices]
    correct: Ints  # [runs, slices]
    low: Floats
    high: Floats
    is_best: Bools

    @property
    def accuracies(self) -> Floats:
        """Fractions of 1, [runs, slices]."""
        with np.errstate(invalid="ignore"):
            return self.correct / self.counts


def accuracy_of_labels(
    correct: Bools, labels: EncodedLabels[Any], clusters: Ints, samples: int = SLICE_SAMPLES
) -> SliceAccuracies:
    """Return the accuracy of each run in each slice.

    Args:
        correct: whether each run is right on each example, [runs, examples].
        labels: the slice of each example, [examples]; a code without a value is in no slice.
        clusters: the cluster of each example, as small whole numbers from 0 (``outcomes.encode_clusters``).

    Raises:
        ValueError: there are not as many labels or clusters as examples.
    """
    _require_same_length(correct, len(labels.codes))
    _require_same_length(correct, len(clusters))
    shape = len(labels.values), int(clusters.max(initial=0)) + 1
    size = shape[0] * shape[1]
    places = labels.codes * shape[1] + clusters
    count, *right = (
        np.bincount(some, minlength=size)[:size]
        for some in (places, *(places[run] for run in correct))
    )
    rights = np.array(right).reshape(-1, *shape)
    return _summarize(labels.values, count.reshape(shape), rights, samples)


def accuracy_where(
    correct: Bools, mask: Bools, clusters: Ints, samples: int = SLICE_SAMPLES
) -> SliceAccuracies:
    """Return the accuracy of each run on the examples of a mask, [examples]: one slice, called True.

    Raises:
        ValueError: the mask or the clusters do not have the length of the examples.
    """
    _require_same_length(correct, len(mask))
    _require_same_length(correct, len(clusters))
    labels = EncodedLabels((True,), (~mask).astype(np.int64))
    return accuracy_of_labels(correct, labels, clusters, samples)


def _require_same_length(correct: Bools, length: int) -> None:
    if correct.shape[1] != length:
        raise ValueError(f"{length} labels do not fit {correct.shape[1]} examples.")


def _summarize(
    values: tuple[Hashable, ...], count: Ints, right: Ints, samples: int
) -> SliceAccuracies:
    """Summarize counts of examples, [slices, clusters], and of right answers, [runs, slices, clusters]."""
    counts, correct = count.sum(-1), right.sum(-1)
    clusters = np.count_nonzero(count, axis=-1)  # [slices]
    low, high = np.full((2, *correct.shape), np.nan)
    is_best = np.zeros(correct.shape, dtype=bool)
    there = np.flatnonzero(counts)
    if len(there) and len(right):
        drawn = accuracies_in_samples(right[:, there], count[there], samples)
        is_best[:, there] = _are_best(drawn, right[:, there])
        ends = np.percentile(drawn, [2.5, 97.5], axis=-1, overwrite_input=True)
        low[:, there], high[:, there] = ends
    is_flat = (counts > 0) & ((correct == 0) | (correct == counts) | (clusters == 1))
    share = correct / np.maximum(counts, 1)
    flat_low, flat_high = wilson_intervals(share * clusters, np.broadcast_to(clusters, share.shape))
    low, high = np.where(is_flat, flat_low, low), np.where(is_flat, flat_high, high)
    return SliceAccuracies(values, counts, correct, low, high, is_best)


def _are_best(samples: Floats, right: Ints) -> Bools:
    """Return which run is better than each other one beyond chance, [runs, slices].

    Args:
        samples: accuracies, [runs, slices, samples].
        right: numbers of right answers, [runs, slices, clusters].
    """
    are_best = np.zeros(right.shape[:-1], dtype=bool)
    if len(right) < 2:
        return are_best
    best = right.sum(-1).argmax(0)  # [slices]
    slices = np.arange(right.shape[1])
    differing = (right[best, slices] != right).sum(-1)  # [runs, slices]
    p = p_values(samples[best, slices] - samples, differing)
    for place in slices:
        others = np.delete(p[:, place], best[place])
        are_best[best[place], place] = bool((holm(others) <= LEVEL).all())
    return are_best


def head_predicates(forms: Sequence[str]) -> list[str]:
    """Return the head predicate of each form; ``UNKNOWN`` for one without."""
    encoded = encode(forms)
    read = (read_or_none(text) for text in encoded.values)
    values = [NO_FORM if form is None else head_predicate(form) for form in read]
    return [values[code] for code in encoded.codes.tolist()]


def bin_names(starts: Sequence[int] = BIN_STARTS) -> tuple[str, ...]:
    """Return the names of the bins of numbers of words, shortest first."""
    inner = (f"{low}–{high - 1} words" for low, high in pairwise(starts))
    return (*inner, f"{starts[-1]} words or more")
