"""Which nonterminals the commands go through."""

from __future__ import annotations

import pytest
from hypothesis import given

from annotations.language.grammar import (
    Budget,
    Grammar,
    TooManyCombinations,
    passages,
    read_productions,
)
from tests.annotations.language.random_grammars import small_grammars

GRAMMAR = Grammar(
    read_productions(
        "$Main = $go | wave\n$go = go to the $place\n$place = {room} | sofa"
    ).productions
)


def test_each_command_names_what_it_goes_through():
    assert passages(GRAMMAR, Budget()) == {
        "go to the <room>": {"go", "place"},
        "go to the sofa": {"go", "place"},
        "wave": set(),
    }


def test_one_looks_at_as_many_derivations_as_are_asked_for():
    assert list(passages(GRAMMAR, Budget(), most=1)) == ["go to the <room>"]


def test_a_spent_budget_ends_it():
    with pytest.raises(TooManyCombinations):
        passages(GRAMMAR, Budget(3))


@given(small_grammars())
def test_the_commands_are_those_of_the_grammar_in_its_order(grammar):
    assert list(passages(grammar, Budget())) == list(grammar.commands())
