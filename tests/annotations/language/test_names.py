"""A name changes everywhere it is meant and nowhere else, and the rest of a text stays as it was written."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from annotations.language.corpus.names import (
    EntityName,
    rename_in_attributes,
    rename_in_conditions,
    rename_in_grounded_form,
    rename_in_template,
    rename_in_utterance,
    rename_nonterminal_in_form,
    rename_nonterminal_in_pattern,
    rename_predicate,
    require_entity_name,
    require_nonterminal,
    require_predicate,
)
from annotations.language.forms import (
    canonical_text,
    predicates,
    print_sequence,
    read_form,
    to_template,
)
from annotations.language.grammar import Grammar, print_production, read_production
from annotations.language.grammar.productions import Production
from annotations.language.grounding import Anonymizer
from annotations.language.texts.errors import LanguageError
from annotations.language.world import Entity, Ontology
from tests.annotations.language.random_forms import forms
from tests.annotations.language.random_grammars import (
    EXPANSIONS,
    LAYERS,
    small_grammars,
)
from tests.annotations.language.sample_ontology import HOME

NEW = "wholly_new_name"
HOUSE = Anonymizer(HOME)
few = settings(deadline=None, max_examples=30)


def names_of(expansion):
    line = read_production(f"$x = {print_sequence(expansion)}")
    return [name for name, _ in line.references]


@few
@given(EXPANSIONS, st.data())
def test_a_nonterminal_renamed_there_and_back_is_the_same_text(expansion, data):
    text = print_sequence(expansion)
    old = data.draw(st.sampled_from([*names_of(expansion), "absent"]))
    there = rename_nonterminal_in_pattern(text, old, NEW)
    assert rename_nonterminal_in_pattern(there, NEW, old) == text
    there_names = [NEW if name == old else name for name in names_of(expansion)]
    assert [name for name, _ in read_production(f"$x = {there}").references] == there_names


@few
@given(small_grammars(), st.sampled_from(LAYERS[1:]))
def test_a_grammar_with_a_renamed_nonterminal_makes_the_same_commands(grammar, old):
    renamed = Grammar(tuple(rename_in_production(each, old) for each in grammar.productions))
    assert commands_of(renamed) == commands_of(grammar)


def rename_in_production(production: Production, old: str) -> Production:
    _, text = print_production(production).split(" = ", 1)
    head = NEW if production.nonterminal == old else production.nonterminal
    return read_production(f"${head} = {rename_nonterminal_in_pattern(text, old, NEW)}")


def commands_of(grammar):
    return list(grammar.commands())


def test_a_nonterminal_of_a_text_that_cannot_be_read_is_renamed_too():
    assert rename_nonterminal_in_pattern("find ($x | $xy", "x", "y") == "find ($y | $xy"


def test_a_nonterminal_is_renamed_as_argument_and_as_predicate():
    form = '($f (λ$1:e (is_a $1 $f)) "$f")'
    assert rename_nonterminal_in_form(form, "f", "g") == '($g (λ$1:e (is_a $1 $g)) "$f")'


@few
@given(forms(), st.data(), st.sampled_from([to_template, canonical_text]))
def test_a_predicate_renamed_there_and_back_is_the_same_text(form, data, write):
    text = write(form)
    old = data.draw(st.sampled_from([*predicates(form), "absent"]))
    there = rename_predicate(text, old, NEW)
    assert rename_predicate(there, NEW, old) == text
    expected = tuple(NEW if name == old else name for name in predicates(form))
    assert predicates(read_form(there)) == expected


def test_a_text_is_no_predicate_and_a_draft_stays():
    assert rename_predicate('(say "go go")', "go", "walk") == '(say "go go")'
    assert rename_predicate("(go (", "go", "walk") == "(go ("


SPOKEN = st.lists(
    st.sampled_from(
        ["tea", "cuppa", "tea room", "knife", "bread knife", "Bo", "the", "tearoom", ",", "in"]
    ),
    max_size=8,
).map(" ".join)


@few
@given(SPOKEN, st.sampled_from(["tea", "knife", "cuppa"]))
def test_an_entity_renamed_there_and_back_is_the_same_utterance(text, old):
    there = rename_in_utterance(text, EntityName("object", old), "zugzwang", HOUSE)
    changed = Anonymizer(Ontology((*HOME.entities, Entity("object", "zugzwang"))))
    back = rename_in_utterance(there, EntityName("object", "zugzwang"), old, changed)
    assert back == text
    assert changed.anonymize(there).text == HOUSE.anonymize(text).text


def test_only_whole_spans_of_the_entity_are_renamed():
    text = "Take tea to the tea room with the bread knife, not the knife"
    renamed = rename_in_utterance(text, EntityName("object", "tea"), "mint tea", HOUSE)
    assert renamed == "Take mint tea to the tea room with the bread knife, not the knife"


def test_a_form_is_renamed_where_its_anonymized_form_has_the_class():
    grounded = '( take ( lambda $1 e ( is_a $1 " tea " ) ) " tea " )'
    classes = '( take ( lambda $1 e ( is_a $1 " <object> " ) ) " tea " )'
    renamed = rename_in_grounded_form(grounded, classes, EntityName("object", "tea"), "mint tea")
    assert renamed == '( take ( lambda $1 e ( is_a $1 " mint tea " ) ) " tea " )'
    other = rename_in_grounded_form(grounded, '( go " <room> " )', EntityName("object", "tea"), "x")
    assert other == grounded


def test_a_template_is_renamed_where_both_sides_write_the_name_out():
    pattern, form = "go to the attic with {name meta: attic}", '(go "attic" {name})'
    assert rename_in_template(pattern, form, "attic", "loft") == (
        "go to the loft with {name meta: attic}",
        '(go "loft" {name})',
    )
    one_side = ("go up to the attic", '(go "roof")')
    assert rename_in_template(*one_side, "attic", "loft") == one_side


def test_conditions_and_attributes_follow():
    text = (
        'the {object where Category="drinks" meta: Category="drinks"} of {name where name = "Bo"}'
    )
    assert rename_in_conditions(text, EntityName("category", "drinks"), "beverages") == (
        'the {object where Category="beverages" meta: Category="drinks"} of {name where name = "Bo"}'
    )
    assert rename_in_conditions(text, EntityName("name", "Bo"), "Kim").endswith('name = "Kim"}')
    attributes = {"category": "drinks", "room": "drinks"}
    renamed = rename_in_attributes(attributes, EntityName("category", "drinks"), "beverages")
    assert renamed == {"category": "beverages", "room": "drinks"}


@pytest.mark.parametrize(
    ("require", "name"),
    [
        (require_nonterminal, "1st"),
        (require_nonterminal, "a b"),
        (require_predicate, "lambda"),
        (require_predicate, "x y"),
        (require_predicate, ""),
        (require_entity_name, " "),
        (require_entity_name, "a <room>"),
    ],
)
def test_a_name_that_would_mean_something_else_is_refused(require, name):
    with pytest.raises(LanguageError) as refused:
        require(name)
    assert refused.value.message
