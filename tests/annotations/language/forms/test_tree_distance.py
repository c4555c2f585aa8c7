from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import (
    Application,
    Form,
    FormDistances,
    Lambda,
    children,
    equivalent,
    read_form,
    walk,
)
from tests.annotations.language.random_forms import forms, renamed


def shuffled(form: Form, seed: int) -> Form:
    """The same form with its conjuncts in another order."""
    parts = [shuffled(child, seed) for child in children(form)]
    if isinstance(form, Lambda) or (isinstance(form, Application) and form.predicate == "and"):
        random.Random(seed).shuffle(parts)
    if isinstance(form, Lambda):
        return Lambda(form.variable, form.type, tuple(parts))
    return Application(form.predicate, tuple(parts)) if isinstance(form, Application) else form


@given(forms(), forms())
def test_it_is_symmetric_between_0_and_1_and_0_exactly_for_equivalent_forms(left, right):
    distance = FormDistances().distance(left, right)
    assert 0 <= distance <= 1
    assert distance == FormDistances().distance(right, left)
    assert (distance == 0) == equivalent(left, right)


@given(forms(), st.integers(1, 5), st.integers())
def test_names_of_variables_and_the_order_of_conjuncts_do_not_count(form, shift, seed):
    other = shuffled(renamed(form, shift), seed)
    assert FormDistances().distance(form, other) == 0


@given(forms(), forms(), forms())
def test_no_detour_is_shorter(first, second, third):
    distances = FormDistances()
    direct = distances.distance(first, third)
    detour = distances.distance(first, second) + distances.distance(second, third)
    assert direct <= detour + 1e-12


@given(forms())
def test_a_predicate_around_a_form_leaves_the_form_as_it_is(form):
    nodes = sum(1 for _ in walk(form))
    assert FormDistances().distance(form, Application("say", (form,))) == pytest.approx(
        1 / (nodes + 1)
    )


@pytest.mark.parametrize(
    ("left", "right", "distance"),
    [
        # bring, λ, is_a, x and the class: five nodes each, four of them shared.
        ('(bring (λ$1:e (is_a $1 "<object>")))', '(find (λ$1:e (is_a $1 "<object>")))', 2 / 6),
        ('(go "kitchen")', '(go "bath")', 2 / 3),
        ('(go "kitchen")', "UNKNOWN", 1),
        # One conjunct is exchanged, wherever it stands.
        (
            '(find (λ$1:e (at $1 "<room>") (is_a $1 "<object>")))',
            '(find (λ$1:e (is_a $1 "<object>") (near $1 "<room>")))',
            2 / 9,
        ),
        # Arguments have an order: both exchange their places.
        ('(put "a" "b")', '(put "b" "a")', 4 / 5),
        # Inside another predicate everything stays.
        ("(say (time))", "(answer (say (time)))", 1 / 3),
    ],
)
def test_distances_worked_out_by_hand(left, right, distance):
    assert FormDistances().distance(read_form(left), read_form(right)) == pytest.approx(distance)
