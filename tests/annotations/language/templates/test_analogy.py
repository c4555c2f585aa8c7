"""a is to b as c is to ? for logical forms."""

from __future__ import annotations

import pytest
from hypothesis import given

from annotations.language.forms import read_form, to_template
from annotations.language.templates.analogy import solve
from tests.annotations.language.random_forms import forms

SAY = "(say {0} (λ$1:e (person $1) {1} (at $1 {{room}})))"


@pytest.mark.parametrize(
    ("a", "b", "c", "answer"),
    [
        ("(go {room})", "(go {beacon})", "(go {room})", "(go {beacon})"),
        ("(find {object})", "(bring {object})", "(find (λ$1:e (is_a $1 {name})))", "(bring (λ$1:e (is_a $1 {name})))"),
        ("(a 1)", "(a 1 2)", "(b 1)", "(b 1 2)"),
        ("(a 1 2)", "(a 1)", "(b 2 1)", "(b 1)"),
        (
            SAY.format("1", "(male $1)"),
            SAY.format("1", "(female $1)"),
            SAY.format("(answer {{question}})", "(male $1)"),
            SAY.format("(answer {{question}})", "(female $1)"),
        ),
    ],
)  # fmt: skip
def test_what_changes_from_a_to_b_changes_in_c(a, b, c, answer):
    forms = (read_form(each.replace("{{", "{").replace("}}", "}")) for each in (a, b, c))
    solved = solve(*forms)
    assert solved == read_form(answer.replace("{{", "{").replace("}}", "}"))
    assert to_template(solved)


def test_a_change_of_what_c_lacks_has_no_answer():
    assert solve(read_form("(a 1 2)"), read_form("(a 1)"), read_form("(b 3 4 5)")) is None


@given(forms(), forms())
def test_a_form_is_to_another_as_itself_is_to_that(a, b):
    assert solve(a, b, a) == b
    assert solve(a, a, b) == b
