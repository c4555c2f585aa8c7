"""Accuracy by slice."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from parser_service.analysis.proportions import wilson_interval
from parser_service.analysis.slicing import (
    NO_FORM,
    accuracy_by,
    accuracy_where,
    are_seen,
    bin_names,
    form_depths,
    head_predicates,
    length_bins,
)

examples = st.lists(st.tuples(st.sampled_from("abc"), st.booleans(), st.booleans()), min_size=1)
GO, BRING = '(go "<room>")', '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'


@given(examples)
def test_slices_are_counted_like_one_at_a_time(rows):
    labels = [label for label, *_ in rows]
    correct = np.array([[first for _, first, _ in rows], [second for *_, second in rows]])
    slices = accuracy_by(correct, labels, values="abc")
    assert slices.values == ("a", "b", "c")
    for place, value in enumerate(slices.values):
        mask = np.array([label == value for label in labels])
        only = accuracy_where(correct, mask)
        assert only.counts[0] == slices.counts[place] == mask.sum()
        for run in range(2):
            right = int((correct[run] & mask).sum())
            assert slices.correct[run, place] == only.correct[run, 0] == right
            if mask.any():
                low, high = wilson_interval(right, int(mask.sum()))
                assert (slices.low[run, place], slices.high[run, place]) == (low, high)
                assert slices.accuracies[run, place] == right / mask.sum()
            else:
                assert np.isnan(slices.accuracies[run, place])


def test_slices_that_are_not_named_follow_in_order_of_appearance():
    slices = accuracy_by(np.ones((1, 3), dtype=bool), ["z", "a", "z"], values=["m"])
    assert slices.values == ("m", "z", "a")
    assert slices.counts.tolist() == [0, 2, 1]


def test_labels_have_to_fit_the_examples():
    with pytest.raises(ValueError, match="2 labels do not fit 3 examples"):
        accuracy_by(np.ones((1, 3), dtype=bool), ["a", "b"])


def test_forms_are_sliced_by_head_predicate_depth_and_whether_training_had_them():
    forms = [GO, BRING, "UNKNOWN", "( go", GO]
    assert head_predicates(forms) == ["go", "bring", "UNKNOWN", NO_FORM, "go"]
    assert form_depths(forms) == [1, 3, 0, NO_FORM, 1]
    assert are_seen(forms, [GO]).tolist() == [True, False, False, False, True]


def test_lengths_fall_into_bins():
    texts = ["", "go", "a b c d", "a b c d e", " ".join("x" * 8), " ".join("x" * 9), "w " * 40]
    assert length_bins(texts) == [
        "1–4 words",
        "1–4 words",
        "1–4 words",
        "5–8 words",
        "5–8 words",
        "9–12 words",
        "17 words or more",
    ]
    assert bin_names((1, 3)) == ("1–2 words", "3 words or more")
