"""Edits whose right form is known."""

from __future__ import annotations

from functools import cache

import pytest

from annotations.language.forms import canonical_text, equivalent, read_form
from annotations.language.grammar import Grammar, read_productions
from annotations.language.world import Entity, Ontology, find_misuses, infer_signatures
from parser_service.analysis.all_edits import generate_edits
from parser_service.analysis.edit import EditKind
from parser_service.analysis.facts import WorldFacts, gather_facts

GRAMMAR = """
$Main = $vbbring me the $thing | $vbbring the $thing to ( me | {name} )
$Main = $vbfind the $thing in the ( {room} | {placement} )
$Main = $vbtake {name} to the {room}
$thing = {kobject} | {category}
$vbbring = bring | give
$vbfind = find | look for
$vbtake = take | guide | bring
$vbput = bring | put
"""
BRING = '(bring (λ$1:e (is_a $1 "<{}>")))'
TO_NAME = '(bring (λ$1:e (is_a $1 "<{}>")) (λ$1:e (person $1) (name $1 "<name>")))'
FIND = '(find (λ$1:e (is_a $1 "<{}>") (at $1 "<{}>")))'
GUIDE = '(guide (λ$1:e (person $1) (name $1 "<name>")) "<room>")'
ENTITIES = [
    ("object", "apple"),
    ("object", "tea"),
    ("category", "drinks"),
    ("room", "kitchen"),
    ("room", "office"),
    ("location", "sofa"),
    ("name", "Bob"),
    ("name", "Anna"),
]


def pairs():
    for kind in ("object", "category"):
        for verb in ("bring", "give"):
            yield f"{verb} me the <{kind}>", BRING.format(kind)
            yield f"{verb} the <{kind}> to me", BRING.format(kind)
            yield f"{verb} the <{kind}> to <name>", TO_NAME.format(kind)
        for verb in ("find", "look for"):
            for place in ("room", "location"):
                yield f"{verb} the <{kind}> in the <{place}>", FIND.format(kind, place)
    for verb in ("take", "guide", "bring"):
        yield f"{verb} <name> to the <room>", GUIDE


@cache
def facts() -> WorldFacts:
    ontology = Ontology(tuple(Entity(kind, text) for kind, text in ENTITIES))
    known = [(text, read_form(form)) for text, form in pairs()]
    grammar = Grammar(read_productions(GRAMMAR).productions)
    return gather_facts(ontology, [grammar], known, infer_signatures(form for _, form in known))


def edits_of(utterance, form, most=9):
    return generate_edits(utterance, read_form(form), facts(), most=most)


def made(utterance, form, kind):
    edits = [each for each in edits_of(utterance, form) if each.kind == kind]
    return {each.text: canonical_text(each.form) for each in edits}


def canonical(form):
    return canonical_text(read_form(form))


def test_synonyms_are_those_of_the_grammar_in_the_same_context():
    assert facts().synonyms["take", "guide", "<name>"] == ("bring", "guide")
    assert facts().synonyms["bring", "bring", "the"] == ("give",)
    assert ("put", "put", "the") not in facts().synonyms
    edits = made("Find the apple in the office", FIND.format("object", "room"), "synonym")
    assert edits == {
        "Look for the apple in the office": canonical(FIND.format("object", "room")),
    }


@pytest.mark.parametrize(
    ("utterance", "edited"),
    [
        ("bring me the apple", "please bring me the apple"),
        ("Bring me the apple.", "Please bring me the apple."),
        ("Could you please bring me the apple?", "Bring me the apple?"),
        ("Robot please bring me the apple", "Bring me the apple"),
        ("bring me the apple, please", "bring me the apple"),
        ("Where is the apple?", "Where is the apple please?"),
        ("I'd like the apple", "I'd like the apple please"),
    ],
)
def test_politeness_is_added_or_taken_away(utterance, edited):
    assert list(made(utterance, BRING.format("object"), "politeness")) == [edited]


def test_an_article_changes_before_a_noun_of_the_world_alone():
    edits = made("bring the apple to the guest", BRING.format("object"), "article")
    assert list(edits) == ["bring an apple to the guest"]
    assert list(made("bring a <object>", BRING.format("object"), "article")) == [
        "bring the <object>"
    ]


def test_two_letters_of_one_long_word_that_names_nothing_are_exchanged():
    (edit,) = (
        each
        for each in edits_of("fetch the apple", BRING.format("object"))
        if each.kind == EditKind.SPELLING
    )
    assert edit.old == "fetch"
    assert sorted(edit.new) == sorted("fetch")
    assert edit.new != "fetch"
    assert edit.text == f"{edit.new} the apple"


def test_another_entity_of_the_class_keeps_a_form_with_class_tokens():
    edits = made("bring me an apple", BRING.format("object"), "entity")
    assert edits == {"bring me a tea": canonical(BRING.format("object"))}


def test_another_entity_of_the_class_changes_a_form_that_names_it():
    edits = made("bring me the apple", '(bring (λ$1:e (is_a $1 "apple")))', "entity")
    assert edits == {"bring me the tea": canonical('(bring (λ$1:e (is_a $1 "tea")))')}


def test_a_recipient_changes_the_form_as_the_grammar_says():
    form, other = BRING.format("object"), TO_NAME.format("object")
    assert made("give the <object> to me", form, "recipient") == {
        "give the <object> to <name>": canonical(other)
    }
    (text,) = made("give me the tea", form, "recipient")
    assert text in {"give Bob the tea", "give Anna the tea"}
    assert made("bring the tea to Bob", other, "recipient") == {
        "bring the tea to me": canonical(form)
    }


def test_what_an_analogy_would_drop_makes_no_edit():
    form = (
        '(bring (λ$1:e (is_a $1 "<object>")) '
        '(λ$1:e (person $1) (name $1 "<name>") (at $1 "<room>")))'
    )
    assert made("bring the tea to Bob in the office", form, "recipient") == {}


def test_a_place_and_a_class_change_their_constant_alone():
    form = FIND.format("object", "room")
    assert made("look for the tea in the kitchen", form, "place") == {
        "look for the tea in the sofa": canonical(FIND.format("object", "location"))
    }
    assert made("look for the tea in the kitchen", form, "class") == {
        "look for the drinks in the kitchen": canonical(FIND.format("category", "room"))
    }


def test_a_place_that_could_be_either_of_two_is_left_alone():
    form = '(bring (λ$1:e (is_a $1 "<object>") (at $1 "<room>")) "<room>")'
    assert made("take the tea from the kitchen to the office", form, "place") == {}


def test_a_label_that_the_grammar_contradicts_makes_no_edit_of_that_command():
    wrong = FIND.format("category", "location")
    assert made("please find the <object> in the <room>", wrong, "politeness") == {}


@pytest.mark.parametrize(("utterance", "form"), list(pairs()))
def test_every_edit_has_a_well_typed_form_that_changes_only_where_it_must(utterance, form):
    original = read_form(form)
    for edit in edits_of(utterance, form):
        assert edit.text != utterance
        assert equivalent(edit.form, original) == edit.kind.keeps_meaning
        assert not list(find_misuses(edit.form, facts().predicates))
        assert not facts().contradicts(edit.text, edit.form)


def test_equal_seeds_give_equal_edits_and_there_are_at_most_so_many_of_a_kind():
    form = read_form(FIND.format("object", "room"))
    text = "please look for the apple in the kitchen"
    edits = generate_edits(text, form, facts(), seed=4)
    assert edits == generate_edits(text, form, facts(), seed=4)
    kinds = [edit.kind for edit in edits]
    assert len(kinds) == len(set(kinds)) >= 6


def test_without_facts_of_the_world_only_the_wording_changes():
    edits = generate_edits("bring me the apple", read_form(BRING.format("object")), WorldFacts())
    assert {edit.kind for edit in edits} == {EditKind.POLITENESS, EditKind.SPELLING}
    assert generate_edits("", read_form("UNKNOWN"), WorldFacts()) == ()
