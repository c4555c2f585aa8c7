"""The canonical layout changes spaces and never a value."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import (
    SymbolReader,
    print_sequence,
    read_form,
    to_corpus,
    to_reading,
    to_template,
)
from annotations.language.grammar import Grammar, read_productions
from annotations.language.templates import correspondences, format_form, format_pattern
from annotations.language.texts.errors import Position
from tests.annotations.language.random_forms import forms
from tests.annotations.language.random_grammars import EXPANSIONS

PRINTERS = st.sampled_from([to_template, to_reading, to_corpus])


@given(forms(), PRINTERS)
def test_a_form_in_any_notation_keeps_its_value(form, printer):
    text = printer(form)
    assert read_form(format_form(text)) == read_form(text)
    assert format_form(format_form(text)) == format_form(text)


@given(EXPANSIONS)
def test_a_pattern_keeps_its_value(symbols):
    text = f" {print_sequence(symbols)}  "
    value = SymbolReader(text, Position()).whole_line()
    assert SymbolReader(format_pattern(text), Position()).whole_line() == value
    assert format_pattern(format_pattern(text)) == format_pattern(text)


@given(st.text('()λ$1:e {}"<>|,room is_a\\\n', max_size=20))
def test_what_cannot_be_read_stays_as_it_is(text):
    for format_side, reads in ((format_form, read_form), (format_pattern, None)):
        try:
            reads(text) if reads else SymbolReader(text.strip(), Position()).whole_line()
        except ValueError:
            assert format_side(text) == text


GRAMMAR = Grammar(read_productions("$Main = $a\n$a = x {object} | $b\n$b = {room 1}\n").productions)


def test_slots_correspond_by_name_and_number_or_through_a_nonterminal():
    pattern, form = "$a in the {room} {object 1}", '(p $a {room 1} {room} "{room}" {object}'
    pairs = [
        (
            [pattern[p.start : p.end] for p in each.in_pattern],
            [form[p.start : p.end] for p in each.in_form],
        )
        for each in correspondences(pattern, form, GRAMMAR)
    ]
    assert pairs == [
        (["$a"], ["$a"]),
        (["$a"], ["{room 1}"]),
        (["{room}"], ["{room}"]),
        (["$a"], ["{object}"]),
    ]
