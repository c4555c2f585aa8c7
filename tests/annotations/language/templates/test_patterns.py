"""A command without a form becomes a pattern that is as general as its siblings allow."""

from __future__ import annotations

from hypothesis import assume, given
from hypothesis import strategies as st

from annotations.language.forms import print_sequence
from annotations.language.grammar import Grammar, read_productions
from annotations.language.templates import PatternMaker, read_template
from tests.annotations.language.random_grammars import small_grammars

GRAMMAR = Grammar(
    read_productions(
        """
        $Main = $polite $order
        $order = $bring me the $object {void meta: Put it there}
        $order = $find a person $pose in the {room 1 meta: a note}
        $order = count the (men | women) in the {room}
        $polite = {void} | please
        $bring = bring | give
        $find = find | look for
        $object = {kobject} | {aobject}
        $pose = sitting | standing
        """
    ).productions
)
SITTING = "find a person sitting in the {room} = (find (λ$1:e (sitting $1)))"
BOTH = "look for the (men | women) = UNKNOWN"


def pattern(command: str, *lines: str, covered: frozenset[str] = frozenset()) -> str:
    made = PatternMaker(GRAMMAR, tuple(map(read_template, lines)), covered).pattern(command)
    return print_sequence(made) if made is not None else ""


def test_words_become_nonterminals_and_notes_go():
    assert pattern("give me the <object>") == "$polite $bring me the $object"


def test_words_that_templates_tell_apart_stay():
    assert pattern("find a person standing in the <room>", SITTING).endswith(
        "a person standing in the {room 1}"
    )


def test_a_sibling_with_a_form_keeps_the_words():
    covered = frozenset({"please bring me the <object>"})
    made = pattern("bring me the <object>", covered=covered)
    assert made in ("$bring me the $object", "$polite bring me the $object", "bring me the $object")
    assert made != "$polite $bring me the $object"


def test_a_choice_that_templates_write_is_written():
    assert (
        pattern("count the men in the <room>", BOTH)
        == "$polite count the (men | women) in the {room}"
    )


def test_a_command_outside_the_grammar_has_no_pattern():
    assert pattern("sing me a song") == ""


@given(small_grammars(), st.data())
def test_a_pattern_makes_its_command_and_none_that_has_a_form(grammar, data):
    assume(not grammar.traversal.cycles and 0 < grammar.size() <= 300)
    commands = list(grammar.commands())
    assume(commands)
    command = data.draw(st.sampled_from(commands))
    covered = frozenset(data.draw(st.sets(st.sampled_from(commands)))) - {command}
    made = PatternMaker(grammar, (), covered).pattern(command)
    assert made is not None
    makes = {" ".join(words) for words, _ in grammar.expander.stream(made)}
    assert command in makes
    assert not makes & covered
