"""Entities of a labelled pair in another form."""

from __future__ import annotations

import pytest

from annotations.language.forms import canonical_text, read_form
from annotations.language.grounding import ground_like

MOVE = '(bring (λ$1:e (is_a $1 "<object>") (at $1 "<location>")) "<location>")'
MOVED = '(bring (λ$1:e (is_a $1 "tea") (at $1 "sink")) "shelf")'


@pytest.mark.parametrize(
    ("form", "grounded"),
    [
        (MOVE.replace("bring", "put"), MOVED.replace("bring", "put")),
        ('(find "<object>")', '(find "tea")'),
        ('(say "<object>" "<object>")', '(say "tea" "tea")'),
        ('(go "<location>")', '(go "<location>")'),
        ('(go "<room>")', '(go "<room>")'),
        ('(go "the yard")', '(go "the yard")'),
    ],
    ids=["in order", "one", "twice", "one of two", "not named", "no token"],
)
def test_entities_go_where_they_are_certain(form, grounded):
    made = ground_like(*map(read_form, (form, MOVE, MOVED)))
    assert canonical_text(made) == canonical_text(read_form(grounded))


def test_the_label_itself_is_grounded_as_it_was():
    assert ground_like(read_form(MOVE), read_form(MOVE), read_form(MOVED)) == read_form(MOVED)


@pytest.mark.parametrize("grounded", ['(go "tea")', "UNKNOWN", MOVE])
def test_a_pair_whose_forms_do_not_fit_each_other_grounds_nothing(grounded):
    form = read_form('(find "<object>")')
    assert ground_like(form, read_form(MOVE), read_form(grounded)) == form
