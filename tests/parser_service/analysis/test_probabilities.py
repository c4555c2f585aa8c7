"""How well the probabilities of answers are calibrated."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from parser_service.analysis.probabilities import reliability

given_and_right = st.lists(st.tuples(st.floats(0, 1), st.booleans()), min_size=1, max_size=60)


def test_the_error_of_a_case_worked_by_hand():
    """Two bins: 0.15 and 0.15 with one right of two, 0.9 with none right of one."""
    measured = reliability([0.15, 0.15, 0.9], np.array([True, False, False]))
    assert measured.error == pytest.approx((2 * 0.35 + 1 * 0.9) / 3)
    assert measured.brier == pytest.approx((0.85**2 + 0.15**2 + 0.9**2) / 3)
    assert [(each.count, each.accuracy) for each in measured.bins] == [(2, 0.5), (1, 0.0)]


def test_the_brier_score_and_the_bins_are_those_of_scikit_learn():
    metrics = pytest.importorskip("sklearn.metrics")
    curves = pytest.importorskip("sklearn.calibration")
    random = np.random.default_rng(0)
    probabilities = random.uniform(0.001, 0.999, 500)
    right = random.uniform(size=500) < probabilities**2
    measured = reliability(probabilities, right)
    assert measured.brier == pytest.approx(metrics.brier_score_loss(right, probabilities))
    shares, means = curves.calibration_curve(right, probabilities, n_bins=10)
    assert [each.accuracy for each in measured.bins] == pytest.approx(shares.tolist())
    assert [each.confidence for each in measured.bins] == pytest.approx(means.tolist())


def test_probabilities_that_keep_their_word_have_a_small_error():
    random = np.random.default_rng(1)
    probabilities = random.uniform(size=20_000)
    right = random.uniform(size=20_000) < probabilities
    assert reliability(probabilities, right).error < 0.02
    assert reliability(probabilities, ~right).error > 0.4


@given(given_and_right)
def test_both_scores_are_shares_and_every_answer_is_in_one_bin(pairs):
    probabilities, right = (np.array(each) for each in zip(*pairs, strict=True))
    measured = reliability(probabilities, right)
    assert 0 <= measured.error <= 1
    assert 0 <= measured.brier <= 1
    assert sum(each.count for each in measured.bins) == len(pairs)
    for each in measured.bins:
        assert each.low - 1e-9 <= each.confidence <= each.high + 1e-9
        low, high = each.interval
        assert 0 <= low <= each.accuracy + 1e-9 <= high + 2e-9


@given(given_and_right)
def test_certainty_that_is_right_costs_nothing(pairs):
    right = np.array([each for _, each in pairs])
    measured = reliability(right.astype(float), right)
    assert (measured.error, measured.brier) == (0, 0)


@pytest.mark.parametrize("scores", [[], [1.2], [float("nan")]])
def test_what_is_no_probability_is_refused(scores):
    with pytest.raises(ValueError):
        reliability(scores, np.zeros(len(scores), dtype=bool))
