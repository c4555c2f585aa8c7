"""Why an answer is wrong."""

from __future__ import annotations

import pytest
from hypothesis import assume, given

from annotations.language.forms import canonical_text, read_form
from parser_service.analysis.category_proposals import propose_category
from parser_service.analysis.error_categories import DESCRIPTIONS, ErrorCategory
from parser_service.analysis.error_evidence import ErrorEvidence, LabelDoubt, Neighbour, RunEvidence
from tests.annotations.language.random_forms import forms

GOLD = read_form('(bring (λ$1:e (is_a $1 "<object>") (at $1 "<room>")))')
WITHOUT_PLACE = read_form('(bring (λ$1:e (is_a $1 "<object>")))')
GO = read_form('(go "<room>")')
TO_NAME = read_form('(bring (λ$1:e (is_a $1 "<object>")) (λ$1:e (person $1) (name $1 "<name>")))')


@pytest.mark.parametrize(
    ("answer", "category", "reason"),
    [
        ('(go "<room>")', "wrong_predicate", "The answer says go instead of bring."),
        ("UNKNOWN", "wrong_predicate", "The answer is UNKNOWN, the label says bring."),
        (
            '(bring (λ$1:e (near $1 "<room>") (is_a $1 "<object>")))',
            "wrong_predicate",
            "The answer says near instead of at.",
        ),
        (
            '(bring (count (λ$1:e (at $1 "<room>") (red $1))))',
            "wrong_predicate",
            "The answer says count and red instead of is_a.",
        ),
        (
            '(bring "<object>")',
            "wrong_argument",
            "The answer gives bring ⟨object⟩ instead of λx. is_a(x, ⟨object⟩) ∧ at(x, ⟨room⟩) as argument 1.",
        ),
        (
            '(bring (λ$1:e (at $1 "<location>") (is_a $1 "<object>")))',
            "wrong_argument",
            "The answer gives at ⟨location⟩ instead of ⟨room⟩ as argument 2.",
        ),
        (
            '(bring (λ$1:e (at $1 "<room>") (is_a $1 "<object>")) "<location>")',
            "wrong_argument",
            "The answer adds argument 2 of bring, ⟨location⟩.",
        ),
        (
            '(bring (λ$1:e (is_a $1 "<object>")))',
            "missing_constraint",
            "The answer lacks the constraint at(x, ⟨room⟩).",
        ),
        (
            '(bring (λ$1:e (at $1 "<room>") (red $1) (is_a $1 "<object>")))',
            "extra_constraint",
            "The answer adds the constraint red(x).",
        ),
        (
            '(say (bring (λ$1:e (is_a $1 "<object>") (at $1 "<room>"))))',
            "wrong_structure",
            "The answer says say around the label's bring.",
        ),
        (
            '(bring (λ$1:e (and (at $1 "<room>") (is_a $1 "<object>"))))',
            "wrong_structure",
            "Label and answer mean the same; only the conjunctions are written differently.",
        ),
        (
            '(bring (λ$1:e (at $1 "<room>") (is_a $1 "<object>")))',
            "wrong_structure",
            "Label and answer mean the same; only the conjunctions are written differently.",
        ),
        (
            '(bring (λ$1:e (on $1 "<location>") (red $1) (is_a $1 "<object>")))',
            "wrong_predicate",
            "The answer says on instead of at.",
        ),
    ],
)
def test_the_difference_of_the_forms_says_why(answer, category, reason):
    first = propose_category(GOLD, read_form(answer)).first
    assert (first.category, first.reason) == (category, reason)


def test_what_is_no_form_is_ill_formed_and_nothing_else():
    proposals = propose_category(GOLD, None, RunEvidence(attractors=frozenset({"x"})))
    assert proposals.first.category is ErrorCategory.ILL_FORMED
    assert proposals.runners_up == ()


def test_what_differs_twice_alike_is_said_once():
    gold = read_form('(sequence (go "<room>") (go "<room>"))')
    answer = read_form('(sequence (go "<location>") (go "<location>"))')
    reason = propose_category(gold, answer).first.reason
    assert reason == "The answer gives go ⟨location⟩ instead of ⟨room⟩ as argument 1."


def test_a_part_of_the_label_is_a_wrong_structure():
    gold = read_form('(say (count (λ$1:e (is_a $1 "<object>"))))')
    first = propose_category(gold, read_form('(count (λ$1:e (is_a $1 "<object>")))')).first
    assert first.category is ErrorCategory.WRONG_STRUCTURE
    assert first.reason == "The answer says count alone, which is only a part of the label's say."


def test_an_attractor_is_an_unexpected_default_where_the_head_differs_and_else_a_runner_up():
    run = RunEvidence(attractors=frozenset({canonical_text(GO), canonical_text(WITHOUT_PLACE)}))
    drastic = propose_category(GOLD, GO, run)
    assert drastic.first.category is ErrorCategory.UNEXPECTED_DEFAULT
    assert ErrorCategory.WRONG_PREDICATE in {each.category for each in drastic.runners_up}
    near = propose_category(GOLD, WITHOUT_PLACE, run)
    assert near.first.category is ErrorCategory.MISSING_CONSTRAINT
    assert near.runners_up[-1].category is ErrorCategory.UNEXPECTED_DEFAULT


def test_a_form_for_what_has_none_may_be_an_unexpected_default():
    proposals = propose_category(read_form("UNKNOWN"), GO)
    assert proposals.first.reason == "The label is UNKNOWN, the answer says go."
    assert [each.category for each in proposals.runners_up] == [ErrorCategory.UNEXPECTED_DEFAULT]


def test_the_papers_umbrella_is_overly_sensitive():
    """“to me” is right, “to Bob” goes to a room although the label hardly changes (table 4)."""
    me = Neighbour("Bring an umbrella to me", WITHOUT_PLACE, WITHOUT_PLACE)
    proposals = propose_category(TO_NAME, GO, error=ErrorEvidence(neighbours=(me,)))
    assert proposals.first.category is ErrorCategory.OVERLY_SENSITIVE
    assert "“Bring an umbrella to me” gets bring(λx. is_a(x, ⟨object⟩))" in proposals.first.reason


def test_an_answer_that_moves_as_far_as_its_label_is_not_overly_sensitive():
    same = Neighbour("Go to the hall", GO, GO)
    moved = propose_category(GOLD, WITHOUT_PLACE, error=ErrorEvidence(neighbours=(same,)))
    assert moved.first.category is ErrorCategory.MISSING_CONSTRAINT
    assert moved.runners_up == ()


def test_an_argument_of_another_kind_is_a_wrong_argument():
    gold = read_form('(say (answer "<question>") (λ$1:e (person $1)))')
    answer = read_form('(say "<whattosay>" (λ$1:e (person $1)))')
    first = propose_category(gold, answer).first
    assert first.category is ErrorCategory.WRONG_ARGUMENT
    assert (
        first.reason
        == "The answer gives say ⟨whattosay⟩ instead of answer(⟨question⟩) as argument 1."
    )


def test_a_part_that_is_lost_counts_more_than_an_argument_that_is_left_over():
    gold = read_form('(say (answer "<question>") (λ$1:e (person $1)))')
    answer = read_form("(say (λ$1:e (person $1)) UNKNOWN)")
    assert propose_category(gold, answer).first.category is ErrorCategory.WRONG_STRUCTURE


def test_an_attractor_that_is_worded_as_usual_is_no_default():
    run = RunEvidence(attractors=frozenset({canonical_text(GO)}))
    usual = propose_category(GOLD, GO, run, ErrorEvidence(is_familiar=True))
    assert usual.first.category is ErrorCategory.WRONG_PREDICATE
    assert usual.runners_up[-1].category is ErrorCategory.UNEXPECTED_DEFAULT


def test_evidence_about_the_label_comes_first():
    audit = LabelDoubt("The command says female, the label male.", GO)
    suggested = propose_category(GOLD, GO, error=ErrorEvidence(audit=audit))
    assert suggested.first.category is ErrorCategory.WRONG_GOLD_LABEL
    assert suggested.first.reason == f"{audit.sentence} The answer is what the audit suggests."
    other = propose_category(GOLD, WITHOUT_PLACE, error=ErrorEvidence(audit=audit))
    assert other.first.category is ErrorCategory.MISSING_CONSTRAINT
    assert other.runners_up[-1].reason == audit.sentence


def test_the_same_text_with_two_labels_is_ambiguous():
    evidence = ErrorEvidence(other_golds=(GO,))
    assert propose_category(GOLD, GO, error=evidence).first.category == "ambiguous_utterance"
    other = propose_category(GOLD, WITHOUT_PLACE, error=evidence)
    assert other.first.category is ErrorCategory.MISSING_CONSTRAINT
    assert other.runners_up[-1].reason == "The same text is also labelled go(⟨room⟩)."


@pytest.mark.parametrize(
    ("run", "reason"),
    [
        (RunEvidence(predicates=frozenset({"bring", "is_a", "at"})), "the predicate go"),
        (RunEvidence(entity_classes=frozenset({"object"})), "the class room"),
    ],
)
def test_what_the_world_does_not_have_is_outside_the_ontology(run, reason):
    first = propose_category(GOLD, GO, run).first
    assert first.category is ErrorCategory.OUTSIDE_ONTOLOGY
    assert first.reason == f"The answer needs {reason}, which the world does not have."


def test_a_right_answer_has_no_category():
    with pytest.raises(ValueError):
        propose_category(GOLD, read_form(canonical_text(GOLD)))


@given(forms(), forms())
def test_any_wrong_answer_gets_one_category_with_a_reason_the_same_each_time(gold, predicted):
    assume(canonical_text(gold) != canonical_text(predicted))
    proposals = propose_category(gold, predicted)
    ranked = [proposals.first, *proposals.runners_up]
    assert all(each.reason.endswith(".") for each in ranked)
    assert len({each.category for each in ranked}) == len(ranked)
    assert proposals == propose_category(gold, predicted)


def test_every_category_is_described():
    assert set(DESCRIPTIONS) == set(ErrorCategory)
