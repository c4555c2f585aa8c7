"""Intervals and comparisons of accuracies whose examples come in clusters."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import wilson_interval
from parser_service.analysis.clustered import Clustered, compare, figures_of, interval_of

tally = st.dictionaries(
    st.text("abcdefgh", min_size=1, max_size=2),
    st.tuples(st.integers(0, 4), st.integers(0, 4)).map(lambda pair: (pair[0], sum(pair))),
    min_size=1,
    max_size=12,
).filter(lambda each: sum(count for _, count in each.values()) > 0)
tallies = st.lists(tally, min_size=1, max_size=3)


def of(*rights: float, clusters: int = 40, size: int = 3, seed: int = 0) -> Clustered:
    """Trainings that are right with these probabilities on the same clusters."""
    random = np.random.default_rng(seed)
    return Clustered.of(
        [{n: (random.binomial(size, right), size) for n in range(clusters)} for right in rights]
    )


def test_single_examples_have_the_interval_of_scipys_bootstrap():
    from scipy import stats

    values = np.random.default_rng(1).integers(0, 2, 300).astype(float)
    expected = stats.bootstrap(
        (values,), np.mean, n_resamples=20_000, method="percentile", rng=np.random.default_rng(2)
    ).confidence_interval
    ours = interval_of((Clustered.of([{n: (each, 1) for n, each in enumerate(values)}]),), 20_000)
    assert ours == pytest.approx((expected.low, expected.high), abs=5e-3)


def test_unequal_clusters_have_the_interval_of_scipys_bootstrap_of_a_ratio():
    from scipy import stats

    random = np.random.default_rng(3)
    count = random.integers(1, 9, 60)
    right = random.binomial(count, 0.7)
    expected = stats.bootstrap(
        (right, count),
        lambda right, count, axis: right.sum(axis) / count.sum(axis),
        paired=True,
        n_resamples=20_000,
        method="percentile",
        rng=np.random.default_rng(4),
    ).confidence_interval
    pairs = enumerate(zip(right, count, strict=True))
    ours = interval_of((Clustered.of([dict(pairs)]),), 20_000)
    assert ours == pytest.approx((expected.low, expected.high), abs=5e-3)


@given(tallies)
def test_an_interval_is_in_order_and_in_bounds(given_tallies):
    low, high = interval_of((Clustered.of(given_tallies),), 200)
    assert 0 <= low <= high <= 1


@given(tallies, st.randoms(use_true_random=False))
def test_the_order_of_clusters_does_not_matter(given_tallies, random):
    shuffled = []
    for each in given_tallies:
        names = list(each)
        random.shuffle(names)
        shuffled.append({name: each[name] for name in names})
    one, other = (Clustered.of(each) for each in (given_tallies, shuffled))
    assert interval_of((one,), 200) == interval_of((other,), 200)


@given(tallies)
def test_clusters_without_examples_change_no_accuracy(given_tallies):
    one = Clustered.of(given_tallies)
    more = one.over([*one.names, "another"])
    assert more.accuracies == pytest.approx(one.accuracies)


def test_the_same_answers_over_and_over_say_as_much_as_once():
    """Nine paraphrases of a command that are always right together."""
    once = Clustered.of([{n: (n % 2, 1) for n in range(30)}])
    often = Clustered.of([{n: (9 * (n % 2), 9) for n in range(30)}])
    assert interval_of((often,)) == pytest.approx(interval_of((once,)))


def test_trainings_that_differ_widen_the_interval():
    alike, apart = of(0.7, 0.7, 0.7), of(0.5, 0.7, 0.9)
    low, high = interval_of((alike,))
    wide_low, wide_high = interval_of((apart,))
    assert wide_high - wide_low > 1.5 * (high - low)


@pytest.mark.parametrize(("right", "expected"), [(0, (0, 12)), (5, (12, 12))])
def test_where_all_clusters_agree_it_is_wilsons_interval_over_them(right, expected):
    every = Clustered.of([dict.fromkeys(range(12), (right, 5))])
    assert interval_of((every,)) == pytest.approx(wilson_interval(*expected))


def test_one_cluster_has_wilsons_interval_whatever_is_right_in_it():
    low, high = interval_of((Clustered.of([{"go": (30, 50)}]),))
    assert (low, high) == pytest.approx(wilson_interval(0.6, 1))
    assert high - low > 0.7


def test_few_clusters_are_never_more_significant_than_their_signs():
    one, other = (Clustered.of([dict.fromkeys(range(4), (right, 10))]) for right in (9, 3))
    assert compare((one,), (other,))[1] == pytest.approx(2**-3)


def test_the_harmonic_mean_lies_between_its_parts_and_its_interval_around_it():
    unseen, known = of(0.4, 0.45), of(0.8, 0.85, seed=1)
    figures = figures_of((unseen, known))
    assert all(unseen.accuracies < figures) and all(figures < known.accuracies)
    low, high = interval_of((unseen, known))
    assert low < figures.mean() < high


def test_a_parser_that_knows_no_new_form_has_a_harmonic_mean_of_nought():
    unseen, known = of(0.0), of(0.9, seed=1)
    assert figures_of((unseen, known)).tolist() == [0.0]
    low, high = interval_of((unseen, known))
    assert low == 0 < high < 0.3


def test_equal_answers_are_no_difference():
    interval, p = compare((of(0.6),), (of(0.6),))
    assert interval == (0, 0)
    assert p == 1


def test_pairing_finds_a_difference_that_intervals_hide():
    """The second is right wherever the first is, and on a few more clusters."""
    first = {n: (n % 2, 1) for n in range(60)}
    second = {**first, **dict.fromkeys(range(0, 16, 2), (1, 1))}
    one, other = (Clustered.of([each]) for each in (first, second))
    (low, high), p = compare((other,), (one,))
    assert 0 < low < high
    assert p < 0.01
    assert interval_of((other,))[0] < interval_of((one,))[1]


def test_a_comparison_turned_round_changes_its_sign_alone():
    one, other = of(0.6), of(0.7, seed=5)
    (low, high), p = compare((one,), (other,))
    (other_low, other_high), other_p = compare((other,), (one,))
    assert (low, high) == pytest.approx((-other_high, -other_low))
    assert p == pytest.approx(other_p)


@pytest.mark.parametrize("given_tallies", [[], [{}], [{"a": (0, 0)}]])
def test_nothing_to_count_is_refused(given_tallies):
    with pytest.raises(ValueError):
        Clustered.of(given_tallies)
