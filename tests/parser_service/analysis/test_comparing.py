"""Runs against each other."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from parser_service.analysis.clustered import Clustered, compare
from parser_service.analysis.comparing import (
    compare_runs,
    count_wins,
    holm,
    mcnemar,
)

matrices = arrays.arrays(
    bool, st.tuples(st.integers(1, 4), st.integers(1, 40)), elements=st.booleans()
)
two_runs = arrays.arrays(bool, st.tuples(st.just(2), st.integers(1, 40)), elements=st.booleans())
p_values = st.lists(st.floats(0, 1), min_size=1, max_size=12)


@given(matrices)
def test_wins_are_what_one_run_has_right_and_the_other_wrong(correct):
    wins = count_wins(correct)
    for i, first in enumerate(correct):
        for j, second in enumerate(correct):
            assert wins[i, j] == sum(a and not b for a, b in zip(first, second, strict=True))


@given(matrices)
def test_every_pair_is_compared_once_and_wins_less_losses_is_the_difference(correct):
    comparisons = compare_runs(correct, alone(correct), samples=50)
    runs = len(correct)
    assert len(comparisons) == runs * (runs - 1) // 2
    accuracies = correct.mean(axis=1)
    for each in comparisons:
        assert each.wins + each.losses + each.ties == correct.shape[1]
        assert each.difference == pytest.approx(accuracies[each.first] - accuracies[each.second])
        assert each.corrected_p >= each.p
        assert each.mcnemar_p >= mcnemar(each.wins, each.losses)
        assert -1 <= each.interval[0] <= each.interval[1] <= 1


@pytest.mark.parametrize(("wins", "losses"), [(0, 0), (1, 0), (7, 2), (12, 30), (400, 350)])
def test_mcnemar_is_the_binomial_test_of_scipy(wins, losses):
    from scipy import stats

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


@given(two_runs, st.integers(1, 6))
def test_two_runs_are_compared_as_two_parsers_of_the_results_are(correct, size):
    clusters = alone(correct) // size
    (ours,) = compare_runs(correct, clusters, samples=200)
    parts = [
        (Clustered.of([{f"{n:02}": tally(run, clusters == n) for n in set(clusters.tolist())}]),)
        for run in correct
    ]
    interval, p = compare(*parts, samples=200)
    assert ours.interval == pytest.approx(interval, abs=1e-6)
    assert ours.p == pytest.approx(p)


def test_answers_that_are_right_together_say_no_more_than_one_of_them():
    random = np.random.default_rng(5)
    few = random.random((2, 12)) < [[0.9], [0.4]]
    often = np.repeat(few, 30, axis=1)
    (apart,) = compare_runs(often, alone(often))
    (together,) = compare_runs(often, alone(often) // 30)
    (once,) = compare_runs(few, alone(few))
    assert apart.p < 0.001 < 0.005 < together.p
    assert (together.interval, together.p) == (pytest.approx(once.interval), once.p)


def test_one_cluster_tells_nothing():
    correct = np.array([[True] * 50, [False] * 50])
    (each,) = compare_runs(correct, np.zeros(50, dtype=np.int64))
    assert (each.p, each.is_significant) == (1.0, False)
    (each,) = compare_runs(correct, alone(correct) // 10)  # a sign test of five: 2 · (1/2)⁵
    assert each.p == pytest.approx(2**-4)


def test_sentences_say_who_is_better_and_whether_that_may_be_chance():
    correct = np.zeros((3, 200), dtype=bool)
    correct[0, :150] = True
    correct[1, :153] = True
    correct[2, :50] = True
    names = ["knn", "seq2seq", "ranker"]
    chance, clear, _ = compare_runs(correct, alone(correct))
    assert chance.meaning(names).startswith(
        "seq2seq is ahead of knn by 1.5 points here, but that may be chance (95 % interval 0.0 to "
    )
    assert clear.is_significant
    assert clear.meaning(names).startswith("knn is more accurate than ranker by 50.0 points (95 %")
    assert "p = 0.001 after Holm" in clear.meaning(names)
    crossed = np.array([[True, False, True], [False, True, True]])
    equal = compare_runs(crossed, alone(crossed))[0]
    assert equal.meaning(names) == (
        "knn and seq2seq are equally accurate, each right on 1 example where the other is not."
    )
    same = compare_runs(correct[[0, 0]], alone(correct))[0]
    assert same.meaning(names) == "knn and seq2seq are right on the same examples."


def test_runs_cannot_be_compared_on_nothing():
    with pytest.raises(ValueError):
        compare_runs(np.zeros((2, 0), dtype=bool), np.zeros(0, dtype=np.int64))


def alone(correct):
    """Each example as a cluster of its own."""
    return np.arange(correct.shape[1])


def tally(run, mask):
    return int(run[mask].sum()), int(mask.sum())
