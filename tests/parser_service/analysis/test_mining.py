"""Pairs of utterances that are one word apart."""

from __future__ import annotations

from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from parser_service.analysis.mining import mine_pairs, words_of
from tests.work import growth

utterances = st.lists(
    st.lists(st.sampled_from(["go", "to", "a", "the"]), max_size=4).map(" ".join), max_size=14
)


def are_one_apart(first, second):
    if len(first) == len(second):
        return sum(a != b for a, b in zip(first, second, strict=True)) == 1
    short, long = sorted((first, second), key=len)
    return any(short == long[:place] + long[place + 1 :] for place in range(len(long)))


@given(utterances)
def test_exactly_the_pairs_one_word_apart_are_found(texts):
    pairs = mine_pairs(texts, most_neighbours=20)
    rows = [words_of(text) for text in texts]
    expected = {
        frozenset((i, j))
        for i, j in combinations(range(len(rows)), 2)
        if rows[i] and rows[j] and rows[i] not in rows[:i] and rows[j] not in rows[:j]
        if are_one_apart(rows[i], rows[j])
    }
    found = [
        frozenset(pair) for pair in zip(pairs.first.tolist(), pairs.second.tolist(), strict=True)
    ]
    assert set(found) == expected
    assert len(found) == len(expected)
    for number in range(len(pairs)):
        old, new = pairs.changed_words(number)
        first, second = rows[pairs.first[number]], rows[pairs.second[number]]
        place = pairs.position[number]
        assert (old or None) == (None if pairs.is_addition[number] else first[place])
        assert second == (*first[:place], new, *first[place + bool(old) :])


def test_case_and_punctuation_do_not_count():
    pairs = mine_pairs(["Bring an umbrella to me.", "bring an umbrella to him", "Go!"])
    assert len(pairs) == 1
    assert pairs.changed_words(0) == ("me", "him")


def test_a_frequent_pattern_gives_a_bounded_number_of_pairs():
    texts = [f"go to room{number}" for number in range(200)]
    pairs = mine_pairs(texts, most_neighbours=3)
    assert len(pairs) == 3 * 200 - (1 + 2 + 3)
    assert set(pairs.first.tolist()) | set(pairs.second.tolist()) == set(range(200))


def test_twice_as_many_utterances_are_twice_the_work():
    def mining(size):
        texts = [f"bring item{number % 97} to room{number}" for number in range(size)]
        return lambda: mine_pairs(texts)

    assert growth(mining, 500) < 2.5
