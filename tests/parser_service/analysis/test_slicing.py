"""Accuracy by slice."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import wilson_interval
from parser_service.analysis.clustered import Clustered, interval_of
from parser_service.analysis.encoded_labels import encode
from parser_service.analysis.intervals import SAMPLES
from parser_service.analysis.slicing import (
    NO_FORM,
    accuracy_of_labels,
    accuracy_where,
    bin_names,
    head_predicates,
)

examples = st.lists(
    st.tuples(st.sampled_from("abc"), st.booleans(), st.booleans(), st.integers(0, 5)), min_size=1
)
EVERY = np.ones((1, 3), dtype=bool)
GO, BRING = '(go "<room>")', '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'


@given(examples)
def test_slices_are_counted_like_one_at_a_time(rows):
    labels = [label for label, *_ in rows]
    clusters = np.array([cluster for *_, cluster in rows])
    correct = np.array([[row[1] for row in rows], [row[2] for row in rows]])
    slices = accuracy_of_labels(correct, encode(labels, "abc"), clusters)
    assert slices.values == ("a", "b", "c")
    for place, value in enumerate(slices.values):
        mask = np.array([label == value for label in labels])
        only = accuracy_where(correct, mask, clusters)
        assert only.counts[0] == slices.counts[place] == mask.sum()
        for run in range(2):
            right = int((correct[run] & mask).sum())
            assert slices.correct[run, place] == only.correct[run, 0] == right
            if mask.any():
                assert slices.accuracies[run, place] == right / mask.sum()
                assert 0 <= slices.low[run, place] <= slices.high[run, place] <= 1
            else:
                assert np.isnan(slices.accuracies[run, place])


def test_the_slice_of_everything_has_the_interval_of_the_results():
    random = np.random.default_rng(3)
    clusters = random.integers(0, 60, 400)
    correct = random.random((1, 400)) < np.linspace(0.2, 1, 60)[clusters]
    all_of_it = accuracy_where(correct, np.ones(400, dtype=bool), clusters, SAMPLES)
    tally = {
        f"{n:02}": (int(correct[0, clusters == n].sum()), int((clusters == n).sum()))
        for n in range(60)
    }
    low, high = interval_of((Clustered.of([tally]),))
    assert (all_of_it.low[0, 0], all_of_it.high[0, 0]) == pytest.approx((low, high), abs=1e-6)


def test_a_slice_has_about_the_interval_of_drawing_its_own_clusters():
    random = np.random.default_rng(4)
    clusters = random.integers(0, 200, 3000)
    correct = random.random((1, 3000)) < np.linspace(0.2, 1, 200)[clusters]
    mask = clusters % 3 == 0
    of_slice = accuracy_where(correct, mask, clusters)
    tally = {
        n: (int(correct[0, clusters == n].sum()), int((clusters == n).sum()))
        for n in range(0, 200, 3)
    }
    low, high = interval_of((Clustered.of([tally]),), 20_000)
    assert (of_slice.low[0, 0], of_slice.high[0, 0]) == pytest.approx((low, high), abs=0.01)


def test_where_clusters_do_not_differ_the_interval_is_wilsons_over_them():
    clusters = np.repeat(np.arange(5), 20)
    right = accuracy_where(np.ones((1, 100), dtype=bool), np.ones(100, dtype=bool), clusters)
    assert (right.low[0, 0], right.high[0, 0]) == pytest.approx(wilson_interval(5, 5))
    half = np.arange(100)[None] % 2 == 0
    one = accuracy_where(half, clusters == 0, clusters)
    assert (one.low[0, 0], one.high[0, 0]) == pytest.approx(wilson_interval(0.5, 1))


def test_the_best_of_a_slice_is_better_beyond_chance():
    random = np.random.default_rng(6)
    correct = random.random((3, 400)) < [[0.9], [0.6], [0.55]]
    clusters, labels = np.arange(400) // 2, ["a"] * 390 + ["b"] * 10
    slices = accuracy_of_labels(correct, encode(labels), clusters)
    assert slices.is_best.tolist() == [[True, False], [False, False], [False, False]]
    alone = accuracy_of_labels(correct[:1], encode(labels), clusters)
    assert not alone.is_best.any()


def test_slices_that_are_not_named_follow_in_order_of_appearance():
    slices = accuracy_of_labels(EVERY, encode(["z", "a", "z"], ["m"]), np.arange(3))
    assert slices.values == ("m", "z", "a")
    assert slices.counts.tolist() == [0, 2, 1]


def test_labels_have_to_fit_the_examples():
    with pytest.raises(ValueError, match=r"2 .* 3 "):
        accuracy_of_labels(EVERY, encode(["a", "b"]), np.arange(3))


def test_forms_are_sliced_by_head_predicate():
    forms = [GO, BRING, "UNKNOWN", "( go", GO]
    assert head_predicates(forms) == ["go", "bring", "UNKNOWN", NO_FORM, "go"]


def test_bins_have_names():
    assert bin_names((1, 3)) == ("1–2 words", "3 words or more")
