"""Refusing to answer."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from parser_service.analysis.risk_coverage import risk_coverage

answers = st.lists(
    st.tuples(st.sampled_from([0.1, 0.2, 0.5, 0.5, 0.9]), st.booleans(), st.booleans()),
    min_size=1,
    max_size=25,
)


def columns(rows):
    scores, correct, unknown = zip(*rows, strict=True)
    return np.array(scores), np.array(correct), np.array(unknown)


@given(answers, st.sampled_from([0.0, 0.2, 0.3, 0.5, 0.9, 2.0]))
def test_a_bound_refuses_what_is_below_it_and_nothing_else(rows, bound):
    scores, correct, unknown = columns(rows)
    refusal = risk_coverage(scores, correct, unknown).at(bound)
    kept = scores >= bound
    assert refusal.answered == kept.sum()
    assert refusal.wrong == (kept & ~correct).sum()
    assert refusal.lost == (~kept & correct & ~unknown).sum()
    assert refusal.gained == (~kept & ~correct & unknown).sum()
    assert refusal.spared == (~kept & ~correct & ~unknown).sum()
    right_after = np.where(kept, correct, unknown)
    assert refusal.accuracy == pytest.approx(right_after.mean())


@given(answers)
def test_the_curve_begins_with_no_answer_and_ends_with_all(rows):
    scores, correct, unknown = columns(rows)
    curve = risk_coverage(scores, correct, unknown)
    assert (curve.answered[0], curve.answered[-1]) == (0, len(rows))
    assert (np.diff(curve.bounds) < 0).all()
    assert (curve.lost[-1], curve.gained[-1], curve.spared[-1]) == (0, 0, 0)
    assert curve.risk[-1] == pytest.approx(1 - correct.mean())
    assert curve.best_area <= curve.area + 1e-12


def area_by_hand(correct):
    risks = [1 - np.mean(correct[: k + 1]) for k in range(len(correct))]
    return np.mean(risks)


def test_the_area_is_the_mean_risk_and_ties_count_as_every_order_of_them():
    assert risk_coverage([4, 3, 2, 1], np.array([True, True, False, True])).area == pytest.approx(
        (0 + 0 + 1 / 3 + 1 / 4) / 4
    )
    tied = risk_coverage([2, 1, 1, 1], np.array([True, True, False, True])).area
    orders = [area_by_hand([True, *rest]) for rest in permutations([True, False, True])]
    assert tied == pytest.approx(np.mean(orders))


def test_a_perfect_parser_and_a_perfect_ranking_have_the_least_area():
    assert risk_coverage([3, 1, 2], np.ones(3, dtype=bool)).area == 0
    curve = risk_coverage([0.9, 0.8, 0.1], np.array([True, True, False]))
    assert curve.area == curve.best_area == pytest.approx(1 / 9)


def test_a_thinned_curve_has_the_same_ends():
    scores = np.random.default_rng(0).random(1000)
    curve = risk_coverage(scores, scores > 0.3)
    thin = curve.thin(50)
    assert len(thin.bounds) <= 50
    assert (thin.bounds[0], thin.bounds[-1]) == (curve.bounds[0], curve.bounds[-1])
    assert thin.at(float(thin.bounds[20])) == curve.at(float(thin.bounds[20]))
    assert thin.area == curve.area


@pytest.mark.parametrize("scores", [[], [float("nan")]])
def test_scores_are_numbers(scores):
    with pytest.raises(ValueError):
        risk_coverage(scores, np.ones(len(scores), dtype=bool))


def test_without_an_answer_there_is_no_risk():
    refusal = risk_coverage([0.5], np.array([False])).at(1.0)
    assert (refusal.risk, refusal.coverage) == (None, 0.0)
