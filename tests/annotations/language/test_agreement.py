from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus.agreement import (
    alpha,
    exact_match,
    gwet_ac1,
    measure,
    read_ratings,
)

# Krippendorff, Computing Krippendorff's Alpha-Reliability (2011), section C: four observers, twelve
# units, some ratings missing. The same ratings are ``cac.raw4raters`` of Gwet's R package irrCAC.
FOUR_OBSERVERS = ["123321412...", "1233224125.3", ".3332342251.", "12332441251."]
# The same, section B: two observers, nominal data.
TWO_OBSERVERS = ["aabbdcccedda", "babbbccceddd"]
# The same, section A: two observers, binary data.
BINARY = ["0100000010", "1110010000"]


def items_of(observers: list[str]) -> list[list[str]]:
    longest = max(map(len, observers))
    rows = (row.ljust(longest, ".") for row in observers)
    return [[value for value in unit if value != "."] for unit in zip(*rows, strict=True)]


def squares(values):
    numbers = np.array([int(value) for value in values])
    return (numbers[:, None] - numbers[None, :]) ** 2


@pytest.mark.parametrize(
    ("observers", "distances", "value"),
    [
        (FOUR_OBSERVERS, None, 0.743),
        (FOUR_OBSERVERS, squares, 0.849),
        (TWO_OBSERVERS, None, 0.692),
        (BINARY, None, 0.095),
    ],
)
def test_alpha_of_the_published_examples(observers, distances, value):
    assert alpha(read_ratings(items_of(observers)), distances).value == pytest.approx(
        value, abs=5e-4
    )


def table(counts: dict[str, int]) -> list[str]:
    return [pair for pair, count in counts.items() for _ in range(count)]


def test_ac1_of_the_published_example():
    # Gwet, Kappa statistic is not satisfactory for assessing the extent of agreement between
    # raters (2002): 118 times both say yes, never both no; κ is −0.02 there.
    ratings = read_ratings(table({"++": 118, "+-": 5, "-+": 2}))
    assert exact_match(ratings).value == pytest.approx(0.944)
    assert gwet_ac1(ratings).value == pytest.approx(0.9408, abs=5e-5)


def test_the_published_table_of_three_values():
    # cont3x3abstractors of irrCAC: its documentation gives 0.89 observed and AC1 = 0.8493.
    rows = {"EE": 13, "AA": 20, "AN": 7, "NA": 4, "NN": 56}
    ratings = read_ratings(table(rows))
    assert exact_match(ratings).value == pytest.approx(0.89)
    assert gwet_ac1(ratings).value == pytest.approx(0.8493, abs=5e-5)


many = st.lists(st.lists(st.sampled_from("abcd"), max_size=3), max_size=12)


@given(many)
def test_intervals_hold_their_values_and_nothing_exceeds_1(items):
    result = measure(items)
    assert result.items == sum(len(values) > 1 for values in items)
    for estimate in (result.exact_match, result.alpha, result.ac1):
        assert estimate.meaning.endswith(".")
        if estimate.value is None:
            assert estimate.interval is None
        elif estimate.interval is not None:
            low, high = estimate.interval
            assert low - 1e-9 <= estimate.value <= 1 + 1e-9
            assert low <= high <= 1 + 1e-9


@given(many, st.randoms())
def test_neither_the_order_of_items_nor_of_people_nor_the_names_of_values_matter(items, random):
    names = dict(zip("abcd", random.sample("wxyz", 4), strict=True))
    other = [[names[value] for value in values] for values in items]
    for values in other:
        random.shuffle(values)
    random.shuffle(other)
    for first, second in zip(values_of(items), values_of(other), strict=True):
        assert first == pytest.approx(second)


def values_of(items):
    result = measure(items)
    return [each.value for each in (result.exact_match, result.alpha, result.ac1)]


def test_a_few_items_have_no_interval():
    result = measure([["a", "a"], ["a", "b"], ["b", "b"], ["b", "b"]])
    assert result.alpha.value is not None
    assert result.alpha.interval is None
    assert "fewer than 30 items" in result.alpha.meaning


def test_people_who_always_agree_have_1_and_a_sentence():
    result = measure([["a", "a"], ["b", "b"], ["c", "c"]] * 20)
    assert [result.exact_match.value, result.alpha.value, result.ac1.value] == [1, 1, 1]
    assert result.alpha.meaning.startswith("The labels are reliable")
    assert result.exact_match.interval[0] < 1  # sixty items do not show more than that


def test_a_small_difference_costs_alpha_less_than_a_large_one():
    def steps(values):
        return [[abs(int(a) - int(b)) / 9 for b in values] for a in values]

    near = measure([["0", "1"], ["5", "5"], ["9", "9"], ["2", "2"]], steps)
    far = measure([["0", "9"], ["5", "5"], ["9", "9"], ["2", "2"]], steps)
    assert near.exact_match == far.exact_match
    assert near.alpha.value > far.alpha.value


def test_where_every_label_is_the_same_alpha_is_not_defined():
    result = measure([["a", "a"]] * 5)
    assert result.alpha.value is None
    assert result.ac1.value == 1


def test_without_items_of_two_people_there_is_nothing_to_say():
    result = measure([["a"], []])
    assert result.items == 0
    assert result.alpha.meaning == "No item has been labelled by two people yet."
