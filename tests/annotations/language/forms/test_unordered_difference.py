"""The difference of forms, whatever the order of their conjuncts."""

from __future__ import annotations

import random
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import (
    Application,
    Change,
    Form,
    Lambda,
    children,
    diff_unordered,
    equivalent,
    read_form,
)
from annotations.language.forms.difference import order_like
from tests.annotations.language.random_forms import forms, renamed


def shuffled(form: Form, chance: random.Random) -> Form:
    """An equivalent form: conjuncts in random order."""
    parts = [shuffled(child, chance) for child in children(form)]
    if isinstance(form, Lambda):
        chance.shuffle(parts)
        return replace(form, bodies=tuple(parts))
    if isinstance(form, Application):
        if form.predicate == "and":
            chance.shuffle(parts)
        return replace(form, arguments=tuple(parts))
    return form


@given(forms(), st.integers())
def test_between_equivalent_forms_nothing_changes(form: Form, seed: int) -> None:
    other = renamed(shuffled(form, random.Random(seed)), 1)
    assert diff_unordered(form, other).cost == 0


@given(forms(), forms())
def test_ordering_keeps_the_meaning_and_only_equivalent_forms_cost_nothing(
    left: Form, right: Form
) -> None:
    assert equivalent(order_like(right, left), right)
    assert (diff_unordered(left, right).cost == 0) == equivalent(left, right)


def test_an_exchanged_conjunct_is_found_where_it_moved() -> None:
    left = read_form('(find (λ$1:e (is_a $1 "<object>") (near $1 "<location>")))')
    right = read_form('(find (λ$1:e (at $1 "<location>") (is_a $1 "<object>")))')
    found = diff_unordered(left, right)
    assert found.cost == 1
    changed = [span.text for span in found.right_spans() if span.change == Change.CHANGED]
    assert changed == ["at"]


def test_conjunctions_without_conjuncts_have_an_order_too() -> None:
    empty = Application("and", ())
    assert order_like(empty, empty) == empty
    both = read_form("(find (λ$1:e (and (red $1) (tall $1))))")
    none = read_form("(find (λ$1:e (and)))")
    assert (order_like(both, none), order_like(none, both)) == (both, none)
