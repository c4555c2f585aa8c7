"""How unlike the texts of a group are, and whether one group is more so than another.

The distance of two texts is 1 − the cosine of their tf-idf vectors (Salton and Buckley, Information
Processing and Management 24, 1988). The mean distance of all pairs of a group follows from the sum of its
vectors, ‖Σv‖² = Σ‖v‖² + Σ cosines, so that no pair is looked at.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from parser_service.analysis.arrays import Floats, Ints
from parser_service.analysis.labels import encode

PERMUTATIONS = 999
_WORD = re.compile(r"<\w+>|\w+")


def unit_vectors(texts: Sequence[str]) -> Floats:
    """Return the tf-idf vectors of texts, of length 1, or 0 for a text without words: [texts, words]."""
    words = [_WORD.findall(text.lower()) for text in texts]
    vocabulary = encode([word for row in words for word in row])
    counts = np.zeros((len(texts), len(vocabulary.values)))
    rows = np.repeat(np.arange(len(texts)), [len(row) for row in words])
    np.add.at(counts, (rows, vocabulary.codes), 1.0)
    in_texts = (counts > 0).sum(axis=0)  # [words]
    vectors = counts * (1 + np.log((1 + len(texts)) / (1 + in_texts)))
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: Floats = np.divide(vectors, lengths, out=vectors, where=lengths > 0)
    return unit


def mean_distance(vectors: Floats) -> float:
    """Return the mean distance of all pairs of at least two vectors, [texts, words]: 0 to 1."""
    return float(_mean_distances(vectors, np.arange(len(vectors))))


def compare_dispersion(
    first: Sequence[str], second: Sequence[str], seed: int, permutations: int = PERMUTATIONS
) -> tuple[float, float, float]:
    """Test whether the texts of one group are more unlike each other than those of another.

    A one-sided permutation test (SciPy's) of the difference between the mean distances; where there are
    few ways to deal the texts to two groups, all of them are tried.

    Args:
        first: at least two texts.
        second: at least two texts.
        seed: equal seeds give equal results.
        permutations: how many are drawn at most.

    Returns:
        The mean distance in each group, and the p-value.
    """
    from scipy.stats import permutation_test  # half a second, which a start can do without

    vectors = unit_vectors([*first, *second])
    places = np.arange(len(vectors))
    groups = places[: len(first)], places[len(first) :]

    def difference(some: Ints, others: Ints, axis: int) -> Floats:
        return _mean_distances(vectors, some) - _mean_distances(vectors, others)

    result = permutation_test(
        groups,
        difference,
        vectorized=True,
        n_resamples=permutations,
        alternative="greater",
        rng=np.random.default_rng(seed),
    )
    one, other = (float(_mean_distances(vectors, group)) for group in groups)
    return one, other, float(result.pvalue)


def _mean_distances(vectors: Floats, places: Ints) -> Floats:
    """Return the mean distance within each group of places, [..., group] → [...]."""
    members = np.zeros((*places.shape[:-1], len(vectors)))
    np.put_along_axis(members, places, 1.0, axis=-1)
    sums = members @ vectors
    own = members @ (vectors**2).sum(axis=1)
    size = places.shape[-1]
    cosines = (sums**2).sum(axis=-1) - own
    distances: Floats = 1 - cosines / (size * (size - 1))
    return distances
