"""Forms suggested by analogy, on a small world where a person would say the same."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import to_template
from annotations.language.grammar import Grammar, read_productions
from annotations.language.templates import (
    MOST_SUGGESTIONS,
    FormSuggester,
    TaskCategory,
    make_template,
    read_template,
    template_checker,
)

GRAMMAR = Grammar(
    read_productions(
        """
        $Main = $polite $bring me the $object
        $Main = $polite $bring me the $object from the {placement}
        $Main = $find the $object in the {room}
        $Main = $find a person $pose in the {room} and tell {whattosay}
        $Main = $find a person $pose in the {room} and answer a {question}
        $Main = go to the {room}
        $Main = put the $object on the {placement}
        $polite = {void} | please
        $bring = bring | give
        $find = find | look for
        $object = {kobject} | {aobject}
        $pose = sitting | standing | {gesture}
        """
    ).productions
)
BRING = "$polite $bring me the $object = (bring (λ$1:e (is_a $1 $object)))"
BRING_FROM = (
    "$polite $bring me the $object from the {placement} = "
    "(bring (λ$1:e (is_a $1 $object) (at $1 {placement})))"
)
FIND = "$find the $object in the {room} = (find (λ$1:e (is_a $1 $object) (at $1 {room})))"
SITTING_TELL = (
    "$find a person sitting in the {room} and tell {whattosay} = "
    "(say {whattosay} (λ$1:e (person $1) (sitting $1) (at $1 {room})))"
)
SITTING_ANSWER = (
    "$find a person sitting in the {room} and answer a {question} = "
    "(say (answer {question}) (λ$1:e (person $1) (sitting $1) (at $1 {room})))"
)
STANDING_TELL = (
    "$find a person standing in the {room} and tell {whattosay} = "
    "(say {whattosay} (λ$1:e (person $1) (standing $1) (at $1 {room})))"
)
STANDING_ANSWER = (
    "$find a person standing in the {room} and answer a {question} = "
    "(say (answer {question}) (λ$1:e (person $1) (standing $1) (at $1 {room})))"
)
PUT = "put the $object on the {placement} = (put (λ$1:e (is_a $1 $object)) {placement})"
LINES = (BRING, BRING_FROM, FIND, SITTING_TELL, SITTING_ANSWER, STANDING_TELL, STANDING_ANSWER, PUT)


def suggester(*lines: str) -> FormSuggester:
    templates = tuple(map(read_template, lines))
    return FormSuggester([TaskCategory("1", GRAMMAR, templates)])


def suggest(pattern: str, *lines: str) -> list[str]:
    symbols = make_template(pattern, "UNKNOWN").pattern
    return [to_template(each.form) for each in suggester(*lines).suggest(symbols, GRAMMAR)]


def test_slots_are_exchanged_for_those_of_the_pattern():
    first, *_ = suggest("$find the {aobject} in the {room 2}", FIND, BRING)
    assert first == "(find (λ$1:e (is_a $1 {aobject}) (at $1 {room 2})))"


def test_a_constraint_goes_with_its_words():
    first, *_ = suggest("$bring me the $object", BRING_FROM, FIND)
    assert first == "(bring (λ$1:e (is_a $1 $object)))"


def test_a_new_slot_is_constrained_as_elsewhere():
    count = "count the $object on the {placement} = (count (λ$1:e (is_a $1 $object) (at $1 {placement})))"
    suggested = suggest("$bring me the $object from the {placement 1}", BRING, count)
    assert "(bring (λ$1:e (is_a $1 $object) (at $1 {placement 1})))" in suggested


@pytest.mark.parametrize("left_out", [SITTING_TELL, SITTING_ANSWER, STANDING_TELL, STANDING_ANSWER])
def test_the_fourth_of_an_analogy_is_suggested_first(left_out):
    template = read_template(left_out)
    rest = [line for line in LINES if line != left_out]
    assert suggest(template.pattern_text, *rest)[0] == to_template(template.form)


@pytest.mark.parametrize(
    "pattern, is_new",
    [
        ("give me the {kobject}", False),
        ("$find the $object", False),
        ("water the {kobject}", True),
    ],
)
def test_a_word_that_no_template_has_makes_a_guess(pattern, is_new):
    symbols = make_template(pattern, "UNKNOWN").pattern
    suggestions = suggester(*LINES).suggest(symbols, GRAMMAR)
    assert {each.share == 0 for each in suggestions} == {is_new}


def test_no_template_no_suggestion():
    assert suggest("go to the {room}") == []


def test_every_suggestion_passes_the_checker_and_keeps_to_the_slots_of_the_pattern():
    for left_out in map(read_template, LINES):
        known = suggester(*(line for line in LINES if line != left_out.pattern_text))
        suggestions = known.suggest(left_out.pattern, GRAMMAR)
        assert 0 < len(suggestions) <= MOST_SUGGESTIONS
        assert_well_typed(known, left_out.pattern_text, suggestions)


PIECES = (
    "$bring", "me", "the", "$object", "{kobject}", "{room}", "{placement 1}", "{placement 2}", "from", "to", "in",
    "$find", "a", "person", "$pose", "sitting", "and", "tell", "{whattosay}", "answer", "{question}", "$polite", ",",
)  # fmt: skip


@given(st.lists(st.sampled_from(PIECES), min_size=1, max_size=12), st.sets(st.sampled_from(LINES)))
def test_whatever_the_pattern_the_suggestions_pass_the_checker(pieces, lines):
    pattern = " ".join(pieces)
    known = suggester(*lines)
    suggestions = known.suggest(make_template(pattern, "UNKNOWN").pattern, GRAMMAR)
    assert len({to_template(each.form) for each in suggestions}) == len(suggestions)
    assert [each.share for each in suggestions] == sorted(
        (each.share for each in suggestions), reverse=True
    )
    assert_well_typed(known, pattern, suggestions[:2])


def assert_well_typed(known, pattern, suggestions):
    checker = template_checker(GRAMMAR, known.predicates)
    slots = set(GRAMMAR.spoken(make_template(pattern, "UNKNOWN").pattern))
    for suggestion in suggestions:
        template = make_template(pattern, to_template(suggestion.form))
        assert {str(slot) for slot in template.slots()} <= {str(slot) for slot in slots}
        messages = [problem.message for problem in checker.problems(template)]
        assert not [each for each in messages if "predicate" in each or "argument" in each]
        assert not [each for each in messages if "never produces" in each]
