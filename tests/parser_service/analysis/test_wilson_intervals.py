"""Intervals of proportions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import wilson_interval, wilson_intervals


@pytest.mark.parametrize(
    ("correct", "count", "low", "high"),
    [
        (0, 10, 0.0, 0.2775),
        (5, 10, 0.2366, 0.7634),
        (10, 10, 0.7225, 1.0),
        (81, 263, 0.2553, 0.3662),
    ],
)
def test_the_interval_is_wilsons(correct, count, low, high):
    assert wilson_interval(correct, count) == pytest.approx((low, high), abs=5e-5)


@given(st.integers(1, 10_000).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))))
def test_the_interval_is_that_of_scipy(pair):
    from scipy import stats

    correct, count = pair
    expected = stats.binomtest(correct, count).proportion_ci(method="wilson")
    assert wilson_interval(correct, count) == pytest.approx((expected.low, expected.high))


def test_many_intervals_at_once_are_those_of_each_and_nothing_has_none():
    low, high = wilson_intervals([[0, 5], [81, 0]], [[10, 10], [263, 0]])
    assert (low[1, 0], high[1, 0]) == wilson_interval(81, 263)
    assert np.isnan(low[1, 1])
    assert np.isnan(high[1, 1])
