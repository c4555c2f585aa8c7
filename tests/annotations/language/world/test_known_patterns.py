"""The patterns that this project has written by hand: each says what the name of its predicate does not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest

from annotations.language.forms import Form, read_form
from annotations.language.texts import KNOWN_PATTERNS
from annotations.language.world import Predicate, gloss, infer_signatures, pattern_of_name
from tests.annotations.language.published import form_lines, needs_corpus

# The starter world has the one predicate that no published pair has.
GESTURE = '(follow (λ$1:e (person $1) (gesture $1 "<gesture>") (at $1 "<room>")))'


@pytest.fixture(scope="module")
def forms() -> list[Form]:
    return [*map(read_form, sorted(set(form_lines("gen", "para")))), read_form(GESTURE)]


@needs_corpus
@pytest.mark.parametrize("name", KNOWN_PATTERNS)
def test_a_pattern_changes_the_gloss_of_a_form(name: str, forms: list[Form]) -> None:
    predicates = infer_signatures(forms)
    assert predicates[name].gloss.startswith(KNOWN_PATTERNS[name])
    plain = {**predicates, name: _named(predicates[name])}
    assert any(_differing(forms, predicates, plain))


def _named(predicate: Predicate) -> Predicate:
    pattern = pattern_of_name(predicate.name, predicate.is_action, predicate.signatures)
    return replace(predicate, gloss=pattern)


def _differing(
    forms: list[Form], one: dict[str, Predicate], other: dict[str, Predicate]
) -> Iterator[bool]:
    return (gloss(form, one) != gloss(form, other) for form in forms)
