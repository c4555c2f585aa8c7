"""Folds of clusters."""

from __future__ import annotations

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from parser_service.analysis.calibration_folds import folds_of


@given(st.lists(st.text(max_size=4)))
def test_each_fold_has_half_of_the_clusters(clusters):
    folds = folds_of(clusters)
    sizes = Counter(folds.values())
    assert not folds or (set(folds) == set(clusters) and 0 <= sizes[0] - sizes[1] <= 1)
    assert bool(folds) == (len(set(clusters)) > 1)


@given(st.lists(st.text(max_size=4)))
def test_order_and_number_of_the_pairs_do_not_matter(clusters):
    assert folds_of(clusters) == folds_of([*reversed(clusters), *clusters])
