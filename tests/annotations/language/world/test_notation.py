"""Signatures are written as people read them, and read back as they were."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from annotations.language.forms import DEFAULT_CLASSES
from annotations.language.texts.errors import LanguageError
from annotations.language.world import (
    Predicate,
    PredicateKind,
    Signature,
    gloss,
    known_kinds,
    print_signatures,
    read_signatures,
    sample_forms,
)

SIGNATURES = st.lists(st.sampled_from(known_kinds(DEFAULT_CLASSES)), max_size=4).map(
    lambda kinds: Signature(tuple(kinds))
)


@settings(deadline=None, max_examples=60)
@given(st.sets(SIGNATURES, max_size=6))
def test_what_is_written_is_read_as_the_same_signatures(signatures):
    assert set(read_signatures(print_signatures(signatures))) == signatures


def test_an_argument_that_may_be_missing_has_a_question_mark():
    signatures = read_signatures("(object, room?, name?)\nlocation")
    assert print_signatures(signatures) == "(location)\n(object, room?, name?)"
    assert len(signatures) == 4
    assert read_signatures("()") == (Signature(()),)


@pytest.mark.parametrize(
    ("text", "line", "named"),
    [
        ("(object\n", 1, None),
        ("(object)\n(planet)", 2, "planet"),
        ("(object?, room)", 1, None),
        ("(object,,room)", 1, None),
        (", ".join(["object"] * 30), 1, r"\b30\b"),
    ],
)
def test_what_is_no_signature_is_refused_with_its_line(text, line, named):
    with pytest.raises(LanguageError, match=named) as refused:
        read_signatures(text)
    assert refused.value.line == line


def test_each_way_to_use_a_predicate_has_a_sentence():
    signatures = read_signatures("(variable, room?)")
    near = Predicate("near", PredicateKind.DESCRIPTION, signatures, "_ near {2} | close _")
    said = [gloss(form, {"near": near}) for form in sample_forms(near)]
    assert [("near the room" in each, "close" in each) for each in said] == [
        (False, True),
        (True, False),
    ]
