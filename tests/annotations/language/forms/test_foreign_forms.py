"""The λ-calculus of other corpora is read as forms that our own notation writes and reads back."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import canonical_text, read_foreign_form, read_form
from annotations.language.texts.errors import LanguageError, Position


@pytest.mark.parametrize(
    ("foreign", "ours"),
    [
        ("(ship $0)", None),
        ("(lambda $0 e (ship $0))", "(λ$0:e (ship $0))"),
        ("( _lambda $0 e ( _ship $0 ) )", "(λ$0:e (_ship $0))"),
        (
            "(lambda $0 e (and (ship $0) (to $0 oslo:ci) (< (hour $0) 1800:ti)))",
            '(λ$0:e (and (ship $0) (to $0 "oslo:ci") (less_than (hour $0) "1800:ti")))',
        ),
        (
            "(lambda $0:e (and:<t*,t> (lake:<l,t> $0) (in:<lo,<lo,t>> $0 norway:co)))",
            '(λ$0:e (and (lake $0) (in $0 "norway:co")))',
        ),
        ("(argmax $0 (lake:t $0) (depth:i $0))", "(argmax (λ$0:e (lake $0)) (λ$0:e (depth $0)))"),
        (
            "(argmin:<x,y> (lambda $0:e (a $0)) (lambda $1:e (b $1)))",
            "(argmin (λ$0:e (a $0)) (λ$1:e (b $1)))",
        ),
        ("(count $1 (and (lake:t $1) (big:t $1)))", "(count (λ$1:e (and (lake $1) (big $1))))"),
        ("(sum $0 (lake:t $0) (area:i $0))", "(sum (λ$0:e (lake $0)) (λ$0:e (area $0)))"),
        ("(owner:na (the $0 (ship $0)))", "(owner (the (λ$0:e (ship $0))))"),
        ("(lambda $0 e (exists $1 (at $0 $1)))", "(λ$0:e (exists (λ$1:e (at $0 $1))))"),
        ("(lambda $0 i (_= (cost (a ci0)) $0))", '(λ$0:i (equals (cost (a "ci0")) $0))'),
        ("(lambda $0 <e,t> (lambda $1 e ($0 $1)))", "(λ$0:e_t (λ$1:e (apply $0 $1)))"),
        ("((lambda $0 e (a $0)) oslo:ci)", '(apply (λ$0:e (a $0)) "oslo:ci")'),
        ("(capital:c norway:co)", '(capital "norway:co")'),
        ("lambda $0 e (a $0)", "(λ$0:e (a $0))"),
        ("lambda $0:e (a $0)", "(λ$0:e (a $0))"),
        ("(lambda $0 (a $0))", "(λ$0:e (a $0))"),
        ("(lambda ?x (a ?x))", "(λ$0:e (a $0))"),
        (
            "(lambda $x <e,t> (argmin ?y ($x ?y) (b ?y)))",
            "(λ$0:e_t (argmin (λ$1:e (apply $0 $1)) (λ$1:e (b $1))))",
        ),
        ("(lambda $0 e (speaks $0 'old norse'))", '(λ$0:e (speaks $0 "old norse"))'),
        ('(near o\'hare:ap 5 -3 0.5 "new oslo")', '(near "o\'hare:ap" 5 -3 "0.5" "new oslo")'),
    ],
)
def test_it_is_read(foreign: str, ours: str | None) -> None:
    if ours is None:
        with pytest.raises(LanguageError):
            read_foreign_form(foreign)
        return
    form = read_foreign_form(foreign)
    assert canonical_text(form) == canonical_text(read_form(ours))
    assert canonical_text(read_form(canonical_text(form))) == canonical_text(form)


@pytest.mark.parametrize(
    ("text", "line", "column"),
    [
        ("(call SW.listValue (string en.meeting))", 1, 1),
        ("(lambda $0 e (and (a $0)\n (call x $0)))", 2, 2),
        ("(a $0)", 1, 4),
        ("(lambda $0 e (a $1))", 1, 17),
        ("(lambda x e (a x))", 1, 1),
        ("(lambda $0 a)", 1, 1),
        ("(from $0 oslo:ci)", 1, 7),
        ("(lambda $0 e)", 1, 1),
        ("(a))", 1, 4),
        ("((a)", 1, 1),
        ("(a) (b)", 1, 5),
        ("(a ())", 1, 4),
        ("(a.b c)", 1, 2),
        ('(a "b)', 1, 4),
        ("oslo:ci", 1, 1),
        ("", 1, 1),
        ("(" * 5_000, 1, 65),
        ("(a " + "b " * 2_600 + ")", 1, 1),
        ("(a " + "b" * 2_600 + ")", 1, 1),
    ],
)
def test_what_is_not_read_has_its_place(text: str, line: int, column: int) -> None:
    with pytest.raises(LanguageError) as refused:
        read_foreign_form(text)
    assert refused.value.position == Position("", line, column)
    place = Position("a.txt", 7, 3)
    with pytest.raises(LanguageError) as refused:
        read_foreign_form(text, place)
    assert refused.value.position == Position("", line, column).inside(place)


@given(st.text(alphabet='()$01abe:<>,t="λ \n', max_size=60))
def test_any_text_is_read_and_written_the_same_or_refused(text: str) -> None:
    try:
        form = read_foreign_form(text)
    except LanguageError:
        return
    assert canonical_text(read_form(canonical_text(form))) == canonical_text(form)
