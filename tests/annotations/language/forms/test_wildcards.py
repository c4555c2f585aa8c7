"""Wildcards: what is read, what is refused and where, and that printing gives the text back."""

import pytest
from hypothesis import given

from annotations.language.forms import (
    DEFAULT_CLASSES,
    Choice,
    Combination,
    Comparison,
    Negation,
    Nonterminal,
    Text,
    Wildcard,
    print_wildcard,
    read_wildcard,
)
from annotations.language.texts.errors import LanguageError, Position
from tests.annotations.language.random_grammars import SEQUENCES, wildcards


def refusal(text):
    with pytest.raises(LanguageError) as caught:
        read_wildcard(text, Position("rules.txt", 3, 10), DEFAULT_CLASSES)
    return caught.value


@given(wildcards(SEQUENCES))
def test_a_printed_wildcard_reads_back_as_the_same_value(wildcard):
    assert read_wildcard(print_wildcard(wildcard)) == wildcard


@pytest.mark.parametrize(
    ("text", "wildcard"),
    [
        ("{room}", Wildcard("room")),
        ("{ kobject? 2 }", Wildcard("kobject", id=2, obfuscated=True)),
        ("{object known 1}", Wildcard("object", "known", 1)),
        ("{object 1 known}", Wildcard("object", "known", 1)),
        ("{pron sub}", Wildcard("pron", "sub")),
        ("{void meta:Stay here}", Wildcard("void", meta=(Text("Stay"), Text("here")))),
        ("{whattosay}", Wildcard("whattosay")),
    ],
)
def test_kind_type_id_and_question_mark_are_read(text, wildcard):
    assert read_wildcard(text) == wildcard


def test_an_alias_has_the_kind_and_type_it_stands_for():
    beacon = read_wildcard("{beacon 1}")
    assert (beacon.kind, beacon.restriction, beacon.entity_class) == (
        "location",
        "beacon",
        "location",
    )
    assert read_wildcard("{room}").entity_class == "room"
    assert read_wildcard("{female}").restriction == "female"


@pytest.mark.parametrize(
    ("text", "wildcard"),
    [
        ("{pose}", Wildcard("pose")),
        ("{pose2}", Wildcard("pose", id=2)),
        ("{hand_side? 1}", Wildcard("hand_side", id=1, obfuscated=True)),
        ("{Garment 2 where colour = {colour 1}}", None),
    ],
)
def test_a_class_that_no_world_at_hand_has_is_read_and_printed_all_the_same(text, wildcard):
    read = read_wildcard(text)
    assert wildcard in (read, None)
    assert read_wildcard(print_wildcard(read)) == read
    assert read.token == f"<{read.entity_class}>"


def test_the_same_name_and_id_are_one_identity_and_another_alias_is_not():
    assert read_wildcard("{room 1}").identity == read_wildcard("{room 1 meta: x}").identity
    assert read_wildcard("{room 1}").identity != read_wildcard("{beacon 1}").identity


def test_tokens_are_those_of_the_anonymized_corpus():
    texts = ["{kobject?}", "{placement 2}", "{room}", "{pron pos}", "{void}", "{question}"]
    tokens = ["<object>", "<location>", "<room>", "them", "", "<question>"]
    assert [read_wildcard(text).token for text in texts] == tokens


def test_conditions_without_and_between_them_are_joined_by_and():
    written = read_wildcard('{object where Category="food" canPour=true}')
    spelled_out = read_wildcard('{object where category = "food" and CANPOUR = true}')
    assert written == spelled_out
    assert written.where == Combination(
        "and", Comparison("category", "=", "food"), Comparison("canpour", "=", True)
    )


def test_not_binds_closer_than_and_and_that_closer_than_or():
    where = read_wildcard("{object where a=1 or not b<>2 and c>=null}").where
    assert where == Combination(
        "or",
        Comparison("a", "=", 1),
        Combination("and", Negation(Comparison("b", "!=", 2)), Comparison("c", ">=", None)),
    )


def test_a_condition_may_compare_with_another_wildcard():
    where = read_wildcard("{object where category = {category 1}}").where
    assert where == Comparison("category", "=", Wildcard("category", id=1))


def test_a_note_holds_wildcards_choices_nonterminals_and_lone_parentheses():
    note = read_wildcard('{void meta: a) see {room 1}, say "$what" (now | later)}').meta
    assert note == (
        Text("a"),
        Text(")"),
        Text("see"),
        Wildcard("room", id=1),
        Text(","),
        Text("say"),
        Text('"'),
        Nonterminal("what"),
        Text('"'),
        Choice(((Text("now"),), (Text("later"),))),
    )


@pytest.mark.parametrize(
    ("text", "column", "named"),
    [
        ("{objct 1}", 11, "{object}"),
        ("{spaceship}", 11, "{spaceship}"),
        ("{}", 11, ""),
        ("{object huge}", 18, "known, alike, special"),
        ("{room 1 2}", 18, "room"),
        ("{room", 10, ""),
        ("{object where}", 23, ""),
        ("{object where a}", 25, ""),
        ("{object where a=}", 26, ""),
        ("{object where (a=1}", 24, ""),
        ("room", 10, "{"),
        ("{room} {room}", 17, ""),
    ],
)
def test_what_cannot_be_read_is_named_with_its_place(text, column, named):
    trouble = refusal(text)
    assert named in str(trouble)
    assert trouble.position == Position("rules.txt", 3, column)


def test_braces_nested_five_thousand_deep_are_refused_at_once():
    assert " 64" in str(refusal("{void meta: " * 5000 + "}" * 5000))


def test_a_where_clause_of_a_thousand_conditions_is_refused():
    assert " 32" in str(refusal("{object where " + " and ".join(["a=1"] * 1000) + "}"))
