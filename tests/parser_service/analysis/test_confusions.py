"""What is taken for what."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import head_predicate, read_form
from parser_service.analysis.confusions import (
    NOTHING,
    SlotConfusion,
    confuse_heads,
    confuse_slots,
)
from parser_service.analysis.encoded_labels import encode

FORMS = [
    '(go "<room>")',
    '(bring (λ$1:e (is_a $1 "<object>") (at $1 "<room>")))',
    '(bring (λ$1:e (at $1 "<location>") (is_a $1 "<category>")) "<location>")',
    "UNKNOWN",
    "( go",
]
pairs = st.lists(st.tuples(st.sampled_from(FORMS), st.sampled_from(FORMS)), max_size=30)


def head(text):
    return "not a form" if text == "( go" else head_predicate(read_form(text))


@given(pairs)
def test_heads_are_counted_like_one_pair_at_a_time(rows):
    confusion = confuse_heads(*(encode([head(row[side]) for row in rows]) for side in (0, 1)))
    expected = Counter((head(gold), head(answer)) for gold, answer in rows)
    for i, said in enumerate(confusion.heads):
        for j, answered in enumerate(confusion.heads):
            assert confusion.counts[i, j] == expected[said, answered]
    assert confusion.counts.sum() == len(rows)
    errors = {(said, answered): count for said, answered, count in confusion.errors()}
    assert errors == {pair: n for pair, n in expected.items() if pair[0] != pair[1]}


def test_slots_are_compared_whatever_the_order_of_conjuncts():
    slots = confuse_slots([FORMS[1], FORMS[1]], [FORMS[2], FORMS[1]])
    assert slots == (
        SlotConfusion("at", 2, "room", "location", 1),
        SlotConfusion("bring", 2, NOTHING, "location", 1),
        SlotConfusion("is_a", 2, "object", "category", 1),
        SlotConfusion("bring", 1, "lambda", "lambda", 2),
        SlotConfusion("at", 2, "room", "room", 1),
        SlotConfusion("is_a", 2, "object", "object", 1),
    )


@given(pairs)
def test_right_answers_confuse_no_slot(rows):
    gold = [form for form, _ in rows]
    assert not any(slot.is_error for slot in confuse_slots(gold, gold))


def test_answers_have_to_fit_the_labels():
    with pytest.raises(ValueError, match=r"1 .* 2 "):
        confuse_slots(FORMS[:2], FORMS[:1])
