"""Unexpected defaults."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from parser_service.analysis.attractors import (
    compare_dispersion,
    find_attractors,
    mean_distances,
    unit_vectors,
)

PATTERNS = {
    "go": ["go to the {}", "navigate to the {}", "enter the {}"],
    "bring": ["bring me the {} from the shelf", "give me the {} from the bar", "get the {} here"],
    "find": ["find a person in the {}", "look for someone in the {}", "locate people in the {}"],
    "say": ["tell me what is in the {}", "say what you see in the {}", "count what the {} has"],
}
PLACES = ["kitchen", "hall", "bedroom", "office", "garden", "bath"]
EXAMPLES = [
    (pattern.format(place), form)
    for form, patterns in PATTERNS.items()
    for pattern, place in product(patterns, PLACES)
]
TEXTS = [text for text, _ in EXAMPLES]
GOLD = [form for _, form in EXAMPLES]


def test_a_parser_that_always_answers_one_form_has_it_as_its_top_attractor():
    from scipy import stats

    top, *others = find_attractors(TEXTS, GOLD, ["go"] * len(GOLD))
    assert not others
    assert top.is_attractor
    assert (top.form, top.predicted, top.missed, top.annotated) == ("go", 54, 0, 18)
    assert top.p_value == pytest.approx(stats.binomtest(54, 54, 0.5, "greater").pvalue)
    assert top.dispersion > top.own_dispersion
    assert top.inputs.tolist() == [n for n, form in enumerate(GOLD) if form != "go"]


def test_a_form_that_training_alone_has_is_compared_with_its_inputs_there():
    known = (["stop now", "stop it now", "please stop now"] * 4, ["stop"] * 12)
    answers = ["stop"] * len(GOLD)
    assert find_attractors(TEXTS, GOLD, answers)[0].dispersion_p is None
    assert find_attractors(TEXTS, GOLD, answers, known)[0].dispersion_p <= 0.01


def test_a_perfect_parser_has_no_attractor():
    assert find_attractors(TEXTS, GOLD, GOLD) == ()
    assert find_attractors([], [], []) == ()


def test_errors_that_go_both_ways_attract_nothing():
    exchanged = [{"go": "find", "find": "go"}.get(form, form) for form in GOLD]
    assert find_attractors(TEXTS, GOLD, exchanged) == ()


def test_a_form_that_takes_in_one_kind_of_input_alone_is_frequent_but_no_attractor():
    """All of “find” become “go”: a confusion, not a default."""
    answers = ["go" if form == "find" else form for form in GOLD]
    (row,) = find_attractors(TEXTS, GOLD, answers)
    assert row.form == "go"
    assert row.q_value < 0.001
    assert row.dispersion_p > 0.05
    assert not row.is_attractor


def test_p_and_q_values_are_those_of_scipy():
    from scipy import stats

    random = np.random.default_rng(3)
    answers = ["go" if random.random() < 0.6 else str(random.choice(["find", "say"])) for _ in GOLD]
    errors = [(gold, answer) for gold, answer in zip(GOLD, answers, strict=True) if gold != answer]
    forms = sorted({answer for _, answer in errors})
    p_values = []
    for form in forms:
        n = sum(answer == form for _, answer in errors)
        missed = sum(gold == form for gold, _ in errors)
        p_values.append(stats.binomtest(n, n + missed, 0.5, "greater").pvalue)
    expected = dict(zip(forms, stats.false_discovery_control(p_values), strict=True))
    rows = find_attractors(TEXTS, GOLD, answers)
    assert rows[0].form == "go"
    for row in rows:
        assert row.q_value == pytest.approx(expected[row.form])


def test_equal_seeds_give_equal_rows():
    def numbers(seed):
        row = find_attractors(TEXTS, GOLD, ["go"] * len(GOLD), seed=seed)[0]
        return row.dispersion, row.dispersion_p

    assert numbers(1) == numbers(1)


@given(st.lists(st.sampled_from([*TEXTS, "", "!"]), min_size=2, max_size=12))
def test_the_mean_distance_is_that_of_all_pairs(texts):
    vectors = unit_vectors(texts)
    pairs = [1 - float(a @ b) for a, b in combinations(vectors, 2)]
    assert mean_distances(vectors, np.arange(len(vectors))) == pytest.approx(np.mean(pairs))


def test_few_texts_are_dealt_in_every_way():
    """Of the 20 ways to deal 3 and 3 texts, only the true one is so uneven."""
    alike, unlike = ["go to bed"] * 3, ["bring tea", "who is there", "find my keys"]
    first, second, p_value = compare_dispersion(unlike, alike, seed=0)
    assert (first, second) == (pytest.approx(1.0), pytest.approx(0.0))
    assert p_value == pytest.approx(1 / 20)


def test_lists_have_to_be_as_long():
    with pytest.raises(ValueError):
        find_attractors(["a"], ["go"], [])
