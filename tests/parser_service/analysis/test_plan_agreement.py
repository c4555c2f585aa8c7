"""Forms that a robot would do the same for."""

from __future__ import annotations

import pickle

import pytest

from annotations.language.forms import read_form
from annotations.language.plans import RecipeBook, default_book
from annotations.language.world import Entity, Ontology
from parser_service.analysis import plan_agreement
from parser_service.analysis.plan_agreement import PlanAgreement
from parser_service.analysis.scores import judge

BRING = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )'
GO_FIND_AND_BRING = (
    '( sequence ( go " <room> " ) ( find ( lambda $1 e ( is_a $1 " <object> " ) ) ) ( bring it ) )'
)


@pytest.fixture
def agree():
    agreement = PlanAgreement(Ontology(()), {}, default_book())
    return lambda first, second: agreement(read_form(first), read_form(second))


def test_the_example_of_the_rulebook_has_the_same_plan(agree):
    """ "Get me a coke from the kitchen", "go to the kitchen, find a coke, and bring it to me"."""
    assert agree(BRING, GO_FIND_AND_BRING)
    assert agree(GO_FIND_AND_BRING, BRING)


@pytest.mark.parametrize(
    "other",
    [
        '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )',  # from nowhere
        '( bring ( lambda $1 e ( is_a $1 " <category> " ) ( at $1 " <room> " ) ) )',
        '( take ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )',
        '( go " <room> " )',
        "UNKNOWN",
    ],
)
def test_other_things_to_do_are_other_plans(agree, other):
    assert not agree(BRING, other)


def test_two_tokens_of_a_class_are_two_entities(agree):
    """A thing is found in one room, and somebody in another: the robot is not there already."""
    found = '( find ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )'
    there = '( bring it ( lambda $1 e ( person $1 ) ( at $1 " <room> " ) ) )'
    anywhere = "( bring it ( lambda $1 e ( person $1 ) ) )"
    assert not agree(f"( sequence {found} {there} )", f"( sequence {found} {anywhere} )")
    in_steps = '( sequence ( go " <room> " ) ( find ( lambda $1 e ( is_a $1 " <object> " ) ) ) '
    assert agree(f"( sequence {found} {there} )", f"{in_steps}{there} )")


def test_numbers_keep_the_tokens_of_a_class_apart(agree):
    there = '( sequence ( go " <room0> " ) ( go " <room1> " ) )'
    assert agree(there, there)
    assert not agree(there, '( sequence ( go " <room1> " ) ( go " <room0> " ) )')


@pytest.mark.parametrize("form", ["UNKNOWN", '( lambda $1 e ( is_a $1 " <object> " ) )'])
def test_what_says_nothing_to_do_agrees_with_nothing(agree, form):
    assert not agree(form, "UNKNOWN")
    assert not agree(form, form)


def test_names_of_variables_do_not_matter(agree):
    assert agree(BRING, BRING.replace("$1", "$7"))


def test_without_recipes_actions_are_compared_as_they_are():
    agreement = PlanAgreement(Ontology(()), {}, RecipeBook())
    assert agreement(read_form('( go " <room> " )'), read_form('( go " <room> " )'))
    assert not agreement(read_form(BRING), read_form(GO_FIND_AND_BRING))


def test_entities_of_the_forms_are_those_of_the_ontology():
    fridge = Entity("location", "fridge", aliases=("cooler",))
    agreement = PlanAgreement(Ontology((fridge,)), {}, default_book())
    assert agreement(read_form('( go " fridge " )'), read_form('( go " fridge " )'))
    assert not agreement(read_form('( go " fridge " )'), read_form('( go " <room> " )'))


def test_it_goes_to_other_processes_and_forgets_plans_when_there_are_many(monkeypatch):
    agreement = pickle.loads(pickle.dumps(PlanAgreement(Ontology(()), {}, default_book())))
    monkeypatch.setattr(plan_agreement, "MOST_KEPT", 2)
    for _ in range(3):
        for room in range(5):
            form = read_form(f'( go " <room{room}> " )')
            assert agreement(form, form)
    assert agreement(read_form(BRING), read_form(GO_FIND_AND_BRING))


def test_an_answer_is_judged_by_its_plan_where_its_form_is_another():
    agreement = PlanAgreement(Ontology(()), {}, default_book())
    judgement = judge(GO_FIND_AND_BRING, BRING, agreement)
    assert (judgement.is_exact_match, judgement.is_equivalent) == (False, False)
    assert judgement.is_same_plan is True
    assert judge("( bring (", BRING, agreement).is_same_plan is False
    assert judge("", BRING, agreement).is_same_plan is False
    assert judge("UNKNOWN", "UNKNOWN", agreement).is_same_plan is True  # it is the very form
    assert judge(GO_FIND_AND_BRING, BRING).is_same_plan is None
