"""When the label is to blame: what an utterance names, words as training uses them, other parsers."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import read_form
from parser_service.analysis.category_proposals import propose_category
from parser_service.analysis.error_evidence import ErrorEvidence, LabelDoubt
from parser_service.analysis.word_use import SpokenFor, WordUse

AT_ROOM = read_form('(put (λ$1:e (is_a $1 "<object>") (at $1 "<room>")) "<location>")')
PUT = read_form('(put (λ$1:e (is_a $1 "<object>")) "<location>")')
BRING = read_form('(bring (λ$1:e (is_a $1 "<object>")) "<location>")')
NAMED = ("location", "object")


def first(gold, predicted, **known):
    proposal = propose_category(gold, predicted, error=ErrorEvidence(**known)).first
    return str(proposal.category), proposal.reason


def test_a_label_with_a_place_for_what_nobody_names_is_wrong():
    category, reason = first(AT_ROOM, PUT, named=NAMED)
    assert category == "wrong_gold_label"
    assert reason == "The label has a place for a room, but the utterance names none."
    assert first(AT_ROOM, PUT)[0] == "missing_constraint"  # nothing is known of names
    assert first(AT_ROOM, PUT, named=("location", "object", "room"))[0] == "missing_constraint"


def test_nothing_is_made_of_names_where_the_answer_has_one_that_nobody_said():
    assert first(AT_ROOM, PUT, named=("location",))[0] == "missing_constraint"
    assert first(PUT, AT_ROOM, named=NAMED)[0] == "extra_constraint"


def test_an_answer_that_is_wrong_besides_is_compared_with_what_was_said():
    assert first(AT_ROOM, BRING, named=NAMED) == (
        "wrong_predicate",
        "The answer says bring instead of put.",
    )


def test_a_label_without_what_the_utterance_names_is_wrong():
    category, reason = first(PUT, AT_ROOM, named=("location", "object", "room"))
    assert category == "wrong_gold_label"
    assert reason == "The utterance names a room, which the label leaves out."


def test_conjunctions_may_be_written_out():
    gold = read_form('(say (λ$1:e (and (thinnest $1) (is_a $1 "<category>"))))')
    assert first(gold, read_form("(say (λ$1:e (thinnest $1)))"), named=())[0] == "wrong_gold_label"


def test_sentences_to_say_need_no_name():
    gold = read_form('(say (answer "<question>") (λ$1:e (name $1 "<name>")))')
    answer = read_form('(say (λ$1:e (name $1 "<name>")))')
    assert first(gold, answer, named=("name",))[0] == "wrong_structure"


@pytest.mark.parametrize(
    ("named", "category"),
    [
        (("location", "object"), "wrong_gold_label"),
        (("location", "object", "question"), "wrong_gold_label"),
        (("object",), "unexpected_default"),
        (("location", "object", "object"), "wrong_predicate"),
    ],
)
def test_a_form_for_what_is_labelled_unknown(named, category):
    assert first(read_form("UNKNOWN"), PUT, named=named)[0] == category


def test_what_the_words_of_the_utterance_correct_is_compared_with_the_answer():
    gold, corrected = (
        read_form("(say (λ$1:e (largest $1)))"),
        read_form("(say (λ$1:e (biggest $1)))"),
    )
    answer = read_form('(say (λ$1:e (biggest $1) (is_a $1 "<category>")))')
    sure = LabelDoubt("It says “biggest”.", corrected, is_sure=True)
    assert first(gold, answer, audit=sure)[0] == "extra_constraint"
    assert first(gold, answer, audit=LabelDoubt("A parser.", corrected))[0] == "wrong_predicate"


def test_a_text_that_training_has_with_other_names_is_ambiguous():
    assert first(PUT, BRING, alike_golds=(PUT, BRING))[0] == "ambiguous_utterance"
    assert first(PUT, BRING, alike_golds=(PUT,))[0] == "wrong_predicate"


def test_a_word_that_goes_with_the_answer_speaks_against_the_label():
    category, reason = first(PUT, BRING, spoken_for=SpokenFor("fetch", 40, 1))
    assert category == "wrong_gold_label"
    assert "“fetch” goes with what the answer says (40 pairs)" in reason


def test_other_parsers_speak_against_the_label_unless_the_answer_makes_something_up():
    agreeing = ("knn", "ranker")
    category, reason = first(PUT, BRING, agreeing=agreeing, named=NAMED)
    assert category == "wrong_gold_label" and reason.startswith("knn and ranker answered the same")
    assert first(PUT, AT_ROOM, agreeing=agreeing, named=NAMED)[0] == "extra_constraint"
    other_order = read_form('(put (λ$1:e (at $1 "<room>") (is_a $1 "<object>")) "<location>")')
    assert first(AT_ROOM, other_order, agreeing=agreeing)[0] == "wrong_structure"


SAY, ASK = "( say ( lambda $1 e ( thin $1 ) ) )", "( bring ( lambda $1 e ( thin $1 ) ) )"
TRAINING = [
    *[(("tell", "me", "the", "thing", f"w{number}"), SAY) for number in range(40)],
    *[(("give", "me", "the", "thing", f"w{number}"), ASK) for number in range(40)],
    (("tell", "them"), ASK),
    (("odd",), "( no form"),
]
MORE, LESS = frozenset({"say"}), frozenset({"bring"})


def test_a_word_speaks_for_the_predicate_that_training_has_it_with():
    use = WordUse(TRAINING)
    assert use.speaks_for(("tell", "me", "the", "thing"), MORE, LESS) == SpokenFor("tell", 40, 1)
    assert use.speaks_for(("me", "the", "thing"), MORE, LESS) is None
    assert use.speaks_for(("give", "me"), MORE, LESS) is None


def test_words_that_speak_for_the_label_outweigh_the_others():
    assert WordUse(TRAINING).speaks_for(("tell", "me", "or", "give", "me"), MORE, LESS) is None


def test_without_pairs_on_both_sides_nothing_is_said():
    use = WordUse(TRAINING)
    assert use.speaks_for(("tell",), MORE, frozenset({"dance"})) is None
    assert use.speaks_for(("tell",), MORE, frozenset()) is None
    assert use.knows(SAY) and not use.knows("( go )")


def test_usual_words_are_those_of_the_head_predicate():
    use = WordUse(TRAINING)
    assert use.is_familiar(("tell", "me", "a", "riddle"), "say")
    assert not use.is_familiar(("open", "that", "door", "the", "<room>"), "say")
    assert not use.is_familiar(("tell",), "go") and not use.is_familiar((), "say")


@given(st.lists(st.sampled_from(["tell", "give", "me", "w1", "<room>", "the", "new"])))
def test_no_word_speaks_for_both(words):
    use = WordUse(TRAINING)
    assert not (use.speaks_for(words, MORE, LESS) and use.speaks_for(words, LESS, MORE))
