"""Whatever is offered while somebody writes can be written."""

from __future__ import annotations

from annotations.language.forms import SymbolReader, read_form
from annotations.language.grammar import Grammar, read_productions
from annotations.language.templates import completions
from annotations.language.texts.errors import Position
from annotations.language.world import infer_signatures

GRAMMAR = Grammar(
    read_productions(
        "$Main = $a the {room 1} | put {object? 2 where fruit = true} in {room 1 meta: not {room 2}} "
        "{void meta: a | b}\n$a = a | b | c | d | e\n"
    ).productions
)
OFFERED = completions(GRAMMAR, infer_signatures([read_form('(bring (λ$1:e (is_a $1 "tea")))')]))


def test_every_slot_that_is_offered_can_be_read():
    for each in (*OFFERED.nonterminals, *OFFERED.wildcards, *OFFERED.conditions):
        (symbol,) = SymbolReader(each.text, Position()).whole_line()
        assert symbol


def test_wildcards_come_as_the_grammar_has_them_and_one_of_each_kind():
    texts = [each.text for each in OFFERED.wildcards]
    assert {"{room 1}", "{room}", "{object? 2}", "{void}", "{pron}"} <= set(texts)
    assert len(texts) == len(set(texts))
    noted = [each.text for each in OFFERED.conditions]
    assert noted == [
        "{object? 2 where fruit = true}",
        "{room 1 meta: not {room 2}}",
        "{void meta: a \\| b}",
    ]


def test_a_long_list_of_alternatives_is_cut():
    a = next(each for each in OFFERED.nonterminals if each.text == "$a")
    assert (a.detail, a.info) == ("a | b | c | d", "a | b | c | d and 1 more")


def test_a_predicate_says_what_it_takes_and_how_it_reads():
    bring = next(each for each in OFFERED.predicates if each.text == "bring")
    assert bring.detail == "(lambda)"
    assert bring.info.startswith("Something to do: “bring me {1}")
