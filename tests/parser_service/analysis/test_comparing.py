"""Runs against each other."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from scipy import stats

from parser_service.analysis.comparing import (
    compare_runs,
    count_wins,
)
from parser_service.analysis.comparing.significance import holm, mcnemar, paired_bootstrap

matrices = arrays.arrays(
    bool, st.tuples(st.integers(1, 4), st.integers(1, 40)), elements=st.booleans()
)
p_values = st.lists(st.floats(0, 1), min_size=1, max_size=12)


@given(matrices)
def test_wins_are_what_one_run_has_right_and_the_other_wrong(correct):
    wins = count_wins(correct)
    for i, first in enumerate(correct):
        for j, second in enumerate(correct):
            assert wins[i, j] == sum(a and not b for a, b in zip(first, second, strict=True))


@given(matrices)
def test_every_pair_is_compared_once_and_wins_less_losses_is_the_difference(correct):
    comparisons = compare_runs(correct, samples=50)
    runs = len(correct)
    assert len(comparisons) == runs * (runs - 1) // 2
    accuracies = correct.mean(axis=1)
    for each in comparisons:
        assert each.wins + each.losses + each.ties == correct.shape[1]
        assert each.difference == pytest.approx(accuracies[each.first] - accuracies[each.second])
        assert each.corrected_p >= each.mcnemar_p
        assert -1 <= each.interval[0] <= each.interval[1] <= 1


@pytest.mark.parametrize(("wins", "losses"), [(0, 0), (1, 0), (7, 2), (12, 30), (400, 350)])
def test_mcnemar_is_the_binomial_test_of_scipy(wins, losses):
    total = wins + losses
    expected = stats.binomtest(wins, total, 0.5).pvalue if total else 1.0
    assert mcnemar(wins, losses) == pytest.approx(expected)


def test_holms_correction_of_the_published_example():
    # Holm's steps by hand: 4 · 0.005, 3 · 0.011, 2 · 0.02, then 0.04, none below the one before.
    assert holm([0.02, 0.005, 0.04, 0.011]) == pytest.approx([0.04, 0.02, 0.04, 0.033])


@given(p_values)
def test_a_corrected_p_value_lies_between_the_raw_one_and_bonferronis(values):
    p = np.array(values)
    corrected = holm(p)
    assert (corrected >= p).all()
    assert (corrected <= np.minimum(1, len(p) * p)).all()
    assert (np.diff(corrected[np.argsort(p, kind="stable")]) >= 0).all()


def test_the_bootstrap_is_that_of_scipy_on_the_examples_themselves():
    random = np.random.default_rng(5)
    first, second = random.random(300) < 0.8, random.random(300) < 0.7
    differences = first.astype(float) - second
    expected = stats.bootstrap(
        (differences,), np.mean, n_resamples=20_000, method="percentile", rng=random
    ).confidence_interval
    wins, losses = int((first & ~second).sum()), int((second & ~first).sum())
    interval, _ = paired_bootstrap(wins, losses, 300, samples=20_000)
    assert interval == pytest.approx((expected.low, expected.high), abs=4e-3)


def test_the_bootstrap_agrees_with_its_interval_and_its_seed():
    interval, p = paired_bootstrap(30, 10, 200)
    assert interval[0] > 0
    assert p < 0.05
    assert (interval, p) == paired_bootstrap(30, 10, 200)
    assert paired_bootstrap(30, 10, 200, seed=1) != (interval, p)
    assert paired_bootstrap(0, 0, 200) == ((0.0, 0.0), 1.0)


def test_sentences_say_who_is_better_and_whether_that_may_be_chance():
    correct = np.zeros((3, 200), dtype=bool)
    correct[0, :150] = True
    correct[1, :153] = True
    correct[2, :50] = True
    names = ["knn", "seq2seq", "ranker"]
    chance, clear, _ = compare_runs(correct)
    assert chance.meaning(names).startswith(
        "seq2seq is ahead of knn by 1.5 points here, but that may be chance (95 % interval 0.0 to "
    )
    assert clear.is_significant
    assert clear.meaning(names).startswith("knn is more accurate than ranker by 50.0 points (95 %")
    assert "p < 0.001" in clear.meaning(names)
    equal = compare_runs(np.array([[True, False, True], [False, True, True]]))[0]
    assert equal.meaning(names) == (
        "knn and seq2seq are equally accurate, each right on 1 example where the other is not."
    )
    same = compare_runs(np.array([correct[0], correct[0]]))[0]
    assert same.meaning(names) == "knn and seq2seq are right on the same examples."


def test_runs_cannot_be_compared_on_nothing():
    with pytest.raises(ValueError, match="no example"):
        compare_runs(np.zeros((2, 0), dtype=bool))
