"""Bootstrap intervals of ratios."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import wilson_interval
from parser_service.analysis.intervals import ratio_interval

shares = st.lists(
    st.tuples(st.integers(0, 3), st.integers(3, 6)).map(lambda pair: (pair[0] / 3, pair[1])),
    min_size=1,
    max_size=30,
)


def test_the_interval_of_a_mean_is_that_of_scipys_bootstrap():
    from scipy import stats

    values = np.random.default_rng(1).beta(2, 5, size=400).round(3)
    expected = stats.bootstrap(
        (values,), np.mean, n_resamples=20_000, method="percentile", rng=np.random.default_rng(2)
    ).confidence_interval
    interval = ratio_interval(values, np.ones(400), samples=20_000)
    assert interval == pytest.approx((expected.low, expected.high), abs=1e-3)


def test_what_comes_in_groups_has_a_wider_interval():
    """Ten equal outcomes of one utterance say as much as one."""
    flips = np.random.default_rng(0).integers(0, 2, 50).astype(float)
    single = ratio_interval(flips, np.ones(50))
    grouped = ratio_interval(10 * flips, np.full(50, 10.0))
    apart = ratio_interval(np.repeat(flips, 10), np.ones(500))
    assert grouped == pytest.approx(single)
    assert apart[1] - apart[0] < (grouped[1] - grouped[0]) / 2


@given(shares)
def test_the_interval_holds_the_ratio_and_is_the_same_each_time(pairs):
    numerators, denominators = np.array(pairs, dtype=float).T
    low, high = ratio_interval(numerators, denominators)
    assert 0 <= low <= high <= 1
    assert (low, high) == ratio_interval(numerators, denominators)


@pytest.mark.parametrize(("share", "right"), [(0.0, 0), (1.0, 12)])
def test_where_samples_cannot_differ_the_interval_is_wilsons(share, right):
    interval = ratio_interval(np.full(12, share), np.ones(12))
    assert interval == wilson_interval(right, 12)


def test_very_many_distinct_values_have_the_interval_of_scipys_bootstrap_too():
    from scipy import stats

    random = np.random.default_rng(4)
    weights = random.integers(1, 5, 3000).astype(float)
    values = random.beta(2, 5, 3000) * weights

    def ratio(numerators, denominators, axis):
        return numerators.sum(axis=axis) / denominators.sum(axis=axis)

    expected = stats.bootstrap(
        (values, weights), ratio, paired=True, method="percentile", n_resamples=2000, rng=random
    ).confidence_interval
    interval = ratio_interval(values, weights)
    assert interval == pytest.approx((expected.low, expected.high), abs=1e-3)


def test_nothing_has_no_interval():
    assert ratio_interval(np.array([]), np.array([])) is None
