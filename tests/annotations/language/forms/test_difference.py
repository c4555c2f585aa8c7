from __future__ import annotations

from hypothesis import given

from annotations.language.forms import Change, Form, canonicalize, diff, read_form, to_reading
from annotations.language.forms.difference import MarkedText
from tests.annotations.language.random_forms import forms, renamed


@given(forms(), forms())
def test_each_column_spells_its_whole_form(left: Form, right: Form) -> None:
    difference = diff(left, right)
    assert "".join(span.text for span in difference.left_spans()) == to_reading(canonicalize(left))
    kept = (span for span in difference.merged_spans() if span.change != Change.REMOVED)
    assert {span.text for span in kept} >= {
        span.text for span in difference.right_spans() if span.change == Change.ADDED
    }
    assert "".join(span.text for span in difference.right_spans()) == to_reading(
        canonicalize(right)
    )


@given(forms(), forms())
def test_the_cost_is_symmetric_and_zero_only_for_equal_forms(left: Form, right: Form) -> None:
    assert diff(left, right).cost == diff(right, left).cost
    assert (diff(left, right).cost == 0) == (canonicalize(left) == canonicalize(right))


@given(forms())
def test_forms_that_differ_in_variable_names_alone_show_no_difference(form: Form) -> None:
    difference = diff(form, renamed(form, 1))
    assert {span.change for span in difference.left_spans()} == {Change.SAME}


def test_a_dropped_conjunct_is_marked_on_the_left_alone() -> None:
    left = read_form('(follow (λ$1:e (person $1) (name $1 "<name>") (at $1 "<location>")))')
    right = read_form('(follow (λ$1:e (person $1) (at $1 "<location>")))')
    difference = diff(left, right)
    assert difference.cost == 3
    assert difference.left_spans() == (
        MarkedText("follow(λx. person(x) ∧ ", Change.SAME),
        MarkedText("name(x, ⟨name⟩)", Change.REMOVED),
        MarkedText(" ∧ at(x, ⟨location⟩))", Change.SAME),
    )
    assert {span.change for span in difference.right_spans()} == {Change.SAME}


def test_an_added_argument_is_marked_on_the_right() -> None:
    difference = diff(read_form("(find (λ$1:e (red $1)))"), read_form("(find (λ$1:e (red $1)) 3)"))
    assert difference.right_spans()[-2] == MarkedText("3", Change.ADDED)


def test_an_exchanged_predicate_is_marked_without_its_arguments() -> None:
    difference = diff(
        read_form("(say (λ$1:e (biggest $1 3)))"), read_form("(say (λ$1:e (largest $1 3)))")
    )
    assert MarkedText("biggest", Change.CHANGED) in difference.left_spans()
    assert MarkedText("largest", Change.CHANGED) in difference.right_spans()
    assert difference.cost == 1


def test_a_form_against_unknown_is_exchanged_as_a_whole() -> None:
    difference = diff(read_form('(go "kitchen")'), read_form("UNKNOWN"))
    assert difference.left_spans() == (MarkedText('go("kitchen")', Change.CHANGED),)
    assert difference.right_spans() == (MarkedText("UNKNOWN", Change.CHANGED),)
