from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import (
    Application,
    Form,
    Lambda,
    Variable,
    canonical_text,
    canonicalize,
    equivalent,
    read_form,
)
from tests.annotations.language.random_forms import forms, renamed


def alpha_equal(first: Form, second: Form, left: tuple[int, ...], right: tuple[int, ...]) -> bool:
    """The textbook definition: bound variables correspond by the λ that binds them."""
    if isinstance(first, Variable) and isinstance(second, Variable):
        return left[::-1].index(first.index) == right[::-1].index(second.index)
    if isinstance(first, Lambda) and isinstance(second, Lambda):
        left, right = (*left, first.variable), (*right, second.variable)
        pairs = (first.bodies, second.bodies) if first.type == second.type else ((), (first,))
    elif isinstance(first, Application) and isinstance(second, Application):
        same = first.predicate == second.predicate
        pairs = (first.arguments, second.arguments) if same else ((), (first,))
    else:
        return first == second
    return len(pairs[0]) == len(pairs[1]) and all(
        alpha_equal(a, b, left, right) for a, b in zip(*pairs, strict=True)
    )


@given(forms(), forms())
def test_canonical_texts_are_equal_exactly_for_alpha_equivalent_forms(a: Form, b: Form) -> None:
    assert (canonical_text(a) == canonical_text(b)) == alpha_equal(a, b, (), ())


@given(forms(), st.integers(min_value=0, max_value=6))
def test_renaming_variables_changes_neither_canonical_text_nor_hash(form: Form, shift: int) -> None:
    other = renamed(form, shift)
    assert canonical_text(other) == canonical_text(form)
    assert hash(canonicalize(other)) == hash(canonicalize(form))
    assert equivalent(other, form)


@given(forms())
def test_a_canonical_form_is_its_own_canonical_form(form: Form) -> None:
    assert canonicalize(canonicalize(form)) == canonicalize(form)
    assert read_form(canonical_text(form)) == canonicalize(form)


@given(forms())
def test_turning_conjuncts_round_keeps_forms_equivalent(form: Form) -> None:
    assert equivalent(form, turned(form))


def turned(form: Form) -> Form:
    if isinstance(form, Lambda):
        return replace(form, bodies=tuple(map(turned, form.bodies[::-1])))
    if isinstance(form, Application):
        order = -1 if form.predicate == "and" else 1
        return replace(form, arguments=tuple(map(turned, form.arguments[::order])))
    return form


def test_variables_are_named_by_depth_and_neighbours_reuse_a_name() -> None:
    form = read_form("(bring (λ$4:e (λ$9:e (near $9 $4))) (λ$2:e (person $2)))")
    assert canonical_text(form) == (
        "( bring ( lambda $1 e ( lambda $2 e ( near $2 $1 ) ) ) ( lambda $1 e ( person $1 ) ) )"
    )


def test_an_inner_variable_may_hide_an_outer_one() -> None:
    form = read_form("(λ$1:e (λ$1:e (red $1)) (big $1))")
    assert canonical_text(form) == "( lambda $1 e ( lambda $2 e ( red $2 ) ) ( big $1 ) )"


def test_a_variable_bound_nowhere_is_captured_by_no_lambda() -> None:
    open_form = Lambda(7, "e", (Application("near", (Variable(7), Variable(1))),))
    assert canonical_text(open_form) == "( lambda $2 e ( near $2 $1 ) )"


def test_order_matters_for_exact_match_and_not_for_equivalence() -> None:
    one = read_form("(find (λ$1:e (red $1) (big $1)))")
    other = read_form("(find (λ$1:e (big $1) (red $1)))")
    assert canonical_text(one) != canonical_text(other)
    assert equivalent(one, other)


def test_the_order_of_arguments_and_the_way_to_write_a_conjunction_matter() -> None:
    assert not equivalent(read_form("(f 1 2)"), read_form("(f 2 1)"))
    bodies = read_form("(λ$1:e (red $1) (big $1))")
    explicit = read_form("(λ$1:e (and (red $1) (big $1)))")
    assert not equivalent(bodies, explicit)
