from __future__ import annotations

import pytest
from hypothesis import given

from annotations.language.forms import (
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    Nonterminal,
    Variable,
    Wildcard,
    depth,
    free_variables,
    head_predicate,
    predicates,
    read_form,
    to_corpus,
    to_reading,
    to_template,
)
from annotations.language.forms.notations import tokens
from annotations.language.texts.errors import LanguageError, Position
from annotations.language.texts.limits import MAX_NESTING
from tests.annotations.language.random_forms import forms

FIND_BOWL = Application(
    "find", (Lambda(1, "e", (Application("is_a", (Variable(1), Constant("bowl"))),)),)
)


@pytest.mark.parametrize(
    "text",
    [
        '(find (λ$1:e (is_a $1 "bowl")))',
        '(find(λ$1:e(is_a $1 "bowl")))',
        '( find ( lambda $1 e ( is_a $1 " bowl " ) ) )',
        '  (find\n (lambda $1:e. (is_a $1   "  bowl ")) )\n',
        'find(λx. is_a(x, "bowl"))',
        'find(lambda x:e. is_a (x,"bowl"))',
    ],
)
def test_three_notations_and_any_spacing_give_one_value(text: str) -> None:
    assert read_form(text) == FIND_BOWL


@given(forms())
def test_reading_undoes_printing_in_every_notation(form: Form) -> None:
    for printed in (to_template(form), to_corpus(form), to_reading(form)):
        assert read_form(printed) == form
        assert hash(read_form(printed)) == hash(form)


def test_several_bodies_stay_distinct_from_an_explicit_and() -> None:
    bodies = read_form("(find (λ$1:e (heavy $1) (red $1)))")
    explicit = read_form("(find (λ$1:e (and (heavy $1) (red $1))))")
    assert bodies != explicit
    assert to_reading(bodies) == "find(λx. heavy(x) ∧ red(x))"
    assert to_reading(explicit) == "find(λx. and(heavy(x), red(x)))"


def test_a_lambda_that_is_not_the_last_conjunct_is_parenthesised_for_reading() -> None:
    form = read_form("(λ$1:e (λ$2:e (near $2 $1)) (red $1))")
    assert to_reading(form) == "λx. (λy. near(y, x)) ∧ red(x)"


def test_the_letters_of_the_reading_notation_go_on_after_z() -> None:
    text = "λx. λy. λz. λx4. among(x, y, z, x4)"
    assert to_reading(read_form(text)) == text


def test_slots_of_a_template_stand_where_arguments_and_predicates_do() -> None:
    form = read_form("(bring (λ$1:e ($oprop $1) (is_a $1 $object)){placement 2})")
    assert isinstance(form, Application)
    assert form.arguments[1] == Wildcard("placement", id=2)
    assert predicates(form) == ("bring", "$oprop", "is_a")
    assert Nonterminal("object") in form.arguments[0].bodies[1].arguments  # type: ignore[union-attr]


def test_unknown_is_a_form_and_an_argument() -> None:
    assert read_form("UNKNOWN") is UNKNOWN
    assert read_form(" ( guide UNKNOWN ) ") == Application("guide", (UNKNOWN,))
    assert head_predicate(UNKNOWN) == "UNKNOWN"


def test_a_number_in_quotation_marks_is_a_text() -> None:
    assert read_form('(find "3")') != read_form("(find 3)")
    assert read_form("(find -3)") == Application("find", (Constant(-3),))


def test_corpus_tokens_split_quoted_texts_into_words() -> None:
    assert tokens(read_form('(go "baby  chair")')) == ("(", "go", '"', "baby", "chair", '"', ")")


def test_a_class_token_is_told_from_a_text_and_read_with_its_number() -> None:
    form = read_form('go(⟨room⟩, ⟨location2⟩, "kitchen")')
    assert [argument.token_class for argument in form.arguments] == ["room", "location", ""]  # type: ignore[union-attr]
    assert to_corpus(form) == '( go " <room> " " <location2> " " kitchen " )'


def test_a_constant_holds_nothing_that_could_not_be_printed() -> None:
    assert Constant('  say\n "hello" ').value == "say 'hello'"


def test_depth_counts_lambdas_and_applications() -> None:
    assert [depth(form) for form in (UNKNOWN, read_form("(go 1)"), FIND_BOWL)] == [0, 1, 3]
    assert free_variables(Application("p", (Variable(2), Lambda(1, "e", (Variable(1),))))) == {2}


@pytest.mark.parametrize(
    ("text", "column", "named"),
    [
        ("(find (λ$1:e (is_a $2 3)))", 20, "$2"),
        ("(say (p (λ$2:e (q $2))) $2)", 25, "$2"),
        ("find(λx. at(x, y))", 16, " y"),
        ("(find (λ$1:e (red $1))", 23, ""),
        ("(find 3))", 9, ") "),
        ("(find 3) (go 4)", 10, "( "),
        ('(find "bowl)', 7, ' " '),
        ('(find " ")', 7, ""),
        ("(find {room)", 7, " { "),
        ("(find <object>)", 7, "<object> "),
        ("(find {{{{{{room}}}}}})", 7, "{ "),
        (f"(find {'bowl' * 30})", 7, "bowlbowl… "),
        (f"(find {'1' * 4_000})", 7, "1 "),
        (f"(find ${'1' * 4_000})", 7, "$ "),
        ("(find bowl)", 7, "bowl "),
        ("(find % 3)", 7, "% "),
        ("(λ$1:e)", 7, ") "),
        ("()", 2, ") "),
        ('  "bowl"', 3, ""),
        ("", 1, ""),
        (" \n ", 1, ""),
    ],
)
def test_what_is_no_form_is_refused_with_its_place(text: str, column: int, named: str) -> None:
    with pytest.raises(LanguageError) as caught:
        read_form(text, Position("a.txt", 7, 1))
    assert named in caught.value.message
    assert caught.value.position == Position("a.txt", 7, column)
    assert caught.value.hint


def test_a_place_inside_a_form_counts_from_where_the_form_begins() -> None:
    with pytest.raises(LanguageError) as same_line:
        read_form("(go $3)", Position("a.txt", 7, 20))
    with pytest.raises(LanguageError) as next_line:
        read_form("(go\n  $3)", Position("a.txt", 7, 20))
    assert same_line.value.position == Position("a.txt", 7, 24)
    assert next_line.value.position == Position("a.txt", 8, 3)


def test_a_wildcard_that_no_world_can_have_is_refused_with_its_place() -> None:
    with pytest.raises(LanguageError) as caught:
        read_form("(go {küche})", Position("a.txt", 2, 11))
    assert caught.value.position.line == 2
    assert 15 <= caught.value.position.column <= 16


@pytest.mark.parametrize("opening", ["(f ", "f(", "λx. "])
def test_nesting_is_read_to_64_and_refused_below_at_once(opening: str) -> None:
    closing = "" if opening == "λx. " else ")"
    assert (
        depth(read_form(opening * MAX_NESTING + "UNKNOWN" + closing * MAX_NESTING)) == MAX_NESTING
    )
    with pytest.raises(LanguageError, match=rf"\b{MAX_NESTING}\b"):
        read_form(opening * 1_000 + "UNKNOWN" + closing * 1_000)
