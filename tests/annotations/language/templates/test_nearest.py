"""The patterns of the grammar that are nearest to a command outside of it."""

from __future__ import annotations

from annotations.language.forms import print_sequence
from annotations.language.grammar import Grammar, read_productions
from annotations.language.templates import nearest_patterns, read_template

GRAMMAR = Grammar(
    read_productions(
        """
        $Main = tell me the (name | gender) of the person at the {beacon}
        $Main = tell me the (name | gender) of the person in the {room}
        $Main = $go to the {room}
        $go = go | walk
        """
    ).productions
)


def nearest(command: str, most: int = 5) -> list[str]:
    lines = ("$go to the {room} = (go {room})", "tell me your gender = UNKNOWN")
    templates = tuple(map(read_template, lines))
    pairs = nearest_patterns(command, GRAMMAR.commands(), GRAMMAR, templates, most)
    return [print_sequence(pattern) for _, pattern in pairs]


def test_the_nearest_comes_first_in_nonterminals():
    first, second = nearest("tell me the gender of the person at the <room>")[:2]
    assert first == "tell me the gender of the person at the {beacon}"
    assert second == "tell me the gender of the person in the {room}"
    assert nearest("run to the <room>")[0] == "$go to the {room}"


def test_patterns_are_distinct_and_as_many_as_asked_for():
    patterns = nearest("tell me the gender of the person at the <room>", most=2)
    assert len(patterns) == len(set(patterns)) == 2
