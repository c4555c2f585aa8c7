import pytest

from parser_service.neural.ranker.holding_out import LEAST_FORMS, MOST_ASKED, hold_out
from parser_service.parsers.interface import Pair
from tests.parser_service.neural.conftest import form


def many(forms, pairs, heads=4):
    return [
        Pair(f"words {number} said {at}", f"( do{number % heads} {number} )", "paraphrased")
        for number in range(forms)
        for at in range(pairs)
    ]


def forms_of(pairs):
    return {pair.form for pair in pairs}


def test_forms_are_held_out_whole_and_utterances_of_others(pairs):
    held = hold_out(pairs, 0)
    assert len(forms_of(held.new)) == 2
    assert not forms_of(held.new) & forms_of(held.train)
    assert forms_of(held.known) <= forms_of(held.train)
    assert not set(held.known) & set(held.train)


def test_an_eighth_of_many_forms_is_held_out_of_all_actions_alike():
    held = hold_out(many(100, 5), 0)
    actions = [form.split()[1] for form in forms_of(held.new)]
    assert len(actions) == 12
    assert {actions.count(action) for action in set(actions)} == {3}


def test_an_action_with_a_single_form_is_not_held_out():
    pairs = [*many(20, 4, heads=1), Pair("go", "( go 1 )")]
    assert all("( go 1 )" not in forms_of(hold_out(pairs, seed).new) for seed in range(9))


def test_of_a_known_form_the_utterances_most_alike_are_held_out_together():
    alike = [Pair(f"take the cup to the {place}", form("bring", "object", "")) for place in "abc"]
    other = [Pair(f"could you fetch me something {at}", alike[0].form) for at in range(7)]
    pairs = [*alike, *other, *many(8, 1)]
    for seed in range(5):
        held = hold_out(pairs, seed)
        if held and alike[0].form in forms_of(held.known):
            assert len(held.known) == 2
            assert len({pair.utterance.split()[0] for pair in held.known}) == 1


@pytest.mark.parametrize("pairs", [many(1, 1), many(LEAST_FORMS - 1, 9), many(30, 1), []])
def test_with_too_few_forms_or_pairs_nothing_is_held_out(pairs):
    assert hold_out(pairs, 0) is None


def test_of_very_many_forms_no_more_are_held_out_than_are_asked():
    held = hold_out(many(2000, 10), 0)
    assert len(forms_of(held.new)) == 40
    assert len(held.new) == MOST_ASKED and len(held.known) == MOST_ASKED
    assert len(forms_of(held.train)) == 1960


def test_it_depends_on_the_seed_alone(pairs):
    assert hold_out(pairs, 3) == hold_out(pairs, 3) != hold_out(pairs, 4)
