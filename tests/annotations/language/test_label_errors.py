"""Labels against their command, their words and a parser."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus.label_errors import (
    LabelledPair,
    Reason,
    ScoredForm,
    check_answers,
    check_commands,
    check_words,
    contradictions,
    rank,
)
from annotations.language.forms import canonical_text, predicates, read_form
from annotations.language.texts import CONTRASTS, NEAR_SYNONYMS, PREDICATE_WORDS

MALE = '( count ( lambda $1 e ( person $1 ) ( male $1 ) ( at $1 " <room> " ) ) )'
FEMALE = MALE.replace("male", "female")
BIGGEST = "( say ( lambda $1 e ( biggest $1 ) ) )"
GO = '( go " <room> " )'


def pair(utterance, form=GO, key="a", source="", source_form=""):
    return LabelledPair(key, utterance, form, source, source_form)


def said(utterance, form, source=""):
    return [
        (each.sentence, each.suggested_form, each.score)
        for each in check_words([pair(utterance, form, source=source)])
    ]


def test_a_word_of_the_opposite_contradicts_and_the_form_is_corrected():
    assert said("How many girls are in the <room>?", MALE) == [
        ("It says “girls”, the form says “male”.", FEMALE, 1.0)
    ]


def test_the_words_of_the_command_count_too():
    ((sentence, form, _),) = said("Count them", FEMALE, source="count the men in the <room>")
    assert sentence == "The command behind it says “men”, the form says “female”."
    assert form == MALE


def test_a_near_synonym_is_weaker_evidence():
    ((_, form, score),) = said("what is the Largest one", BIGGEST)
    assert (form, score) == (BIGGEST.replace("biggest", "largest"), 0.5)


@pytest.mark.parametrize(
    "utterance",
    [
        "how many people are not girls",
        "how many people aren’t girls",
        "count the boys, no matter how many girls there are",
        "how many people are here",
        "count the girlfriends",
    ],
)
def test_nothing_is_said_of_negations_own_words_and_parts_of_words(utterance):
    assert not said(utterance, MALE)


def test_a_word_that_another_predicate_explains_contradicts_nothing():
    both = "( say ( lambda $1 e ( male $1 ) ( female $1 ) ) )"
    assert not said("which are girls", both)


def test_a_label_that_cannot_be_read_is_passed_over():
    assert not said("girls", "( male")


@given(st.sampled_from([name for group in CONTRASTS for name in group]), st.data())
def test_what_is_corrected_says_what_the_word_says(predicate, data):
    (group,) = (group for group in CONTRASTS if predicate in group)
    other = data.draw(st.sampled_from([name for name in group if name != predicate]))
    word = data.draw(st.sampled_from(PREDICATE_WORDS[other]))
    form = read_form(f"( say ( lambda $1 e ( person $1 ) ( {predicate} $1 ) ) )")
    text = f"the one {word} it"
    (found,) = contradictions(text, form)
    corrected = found.corrected(form)
    assert predicates(corrected) == ("say", "person", other)
    assert not list(contradictions(text, corrected))


def test_every_predicate_with_a_contrast_has_words_of_its_own():
    named = {name for group in (*CONTRASTS, *NEAR_SYNONYMS) for name in group}
    assert named == set(PREDICATE_WORDS)
    words = [word for words in PREDICATE_WORDS.values() for word in words]
    assert len(words) == len(set(words))


@pytest.mark.parametrize(
    "label, of_command, what, score",
    [
        (GO, '( find " <room> " )', "has another form", 1.0),
        (GO, "UNKNOWN", "has no form (UNKNOWN)", 0.2),
        (
            "( find ( lambda $1 e ( and ( person $1 ) ( male $1 ) ) ) )",
            "( find ( lambda $1 e ( male $1 ) ( person $1 ) ) )",
            "writes the same meaning in another way",
            0.2,
        ),
    ],
)
def test_a_label_that_is_not_the_form_of_its_command(label, of_command, what, score):
    (finding,) = check_commands([pair("go", label, source="walk", source_form=of_command)])
    assert finding.sentence == f"The command behind it, “walk”, {what}."
    assert (finding.suggested_form, finding.score) == (of_command, score)


def test_the_same_form_and_no_known_form_are_no_findings():
    assert not list(check_commands([pair("go", source="walk", source_form=GO), pair("run")]))


def test_a_parser_that_is_further_ahead_of_the_label_is_stronger_evidence():
    answers = {
        "sure": [ScoredForm(MALE, 0.9), ScoredForm(GO, 0.1)],
        "doubtful": [ScoredForm(MALE, 0.5), ScoredForm(GO, 0.4)],
        "tied": [ScoredForm(MALE, 0.5), ScoredForm(GO, 0.5)],
        "right": [ScoredForm(GO, 0.5), ScoredForm(MALE, 0.4)],
        "silent": [],
    }
    found = check_answers([pair("go", key=key) for key in answers], answers, "Knn")
    assert [(each.pair.key, each.score) for each in found] == [("sure", 1.0), ("doubtful", 0.5)]
    assert {each.suggested_form for each in found} == {MALE}


def test_a_parser_that_means_the_same_is_not_against_the_label():
    label = "( find ( lambda $1 e ( and ( person $1 ) ( male $1 ) ) ) )"
    other = "( find ( lambda $1 e ( male $1 ) ( person $1 ) ) )"
    assert not check_answers([pair("go", label)], {"a": [ScoredForm(other, 0.9)]}, "Knn")


@given(st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), max_size=20), st.floats(0.1, 9))
def test_the_unit_of_the_scores_has_no_effect(scores, unit):
    pairs = [pair("go", key=str(number)) for number in range(len(scores))]

    def found(factor):
        answers = {
            str(number): [ScoredForm(MALE, max(some) * factor), ScoredForm(GO, min(some) * factor)]
            for number, some in enumerate(scores)
        }
        return [each.pair.key for each in check_answers(pairs, answers, "Knn") if each.score]

    assert found(1) == found(2.0 ** round(unit))


def test_several_reasons_come_first_but_weak_ones_do_not_count():
    one = pair("girls", MALE, "one", "count the men", MALE)
    two = pair("girls", MALE, "two", "count the girls", FEMALE)
    weak = pair("walk", GO, "weak", "go", "UNKNOWN")
    suspects = rank([*check_commands([weak, two, one]), *check_words([weak, two, one])])
    assert [each.pair.key for each in suspects] == ["two", "one", "weak"]
    assert suspects[0].reasons == {Reason.COMMAND, Reason.WORD}
    assert [each.strong_reasons for each in suspects] == [2, 1, 0]
    assert suspects[0].score == 2.0
    assert suspects[0].suggested_form == canonical_text(read_form(FEMALE))


@given(st.permutations(["a", "b", "c", "d"]))
def test_the_order_of_the_findings_has_no_effect(keys):
    pairs = [pair("girls", MALE, key) for key in keys]
    assert [each.pair.key for each in rank(check_words(pairs))] == ["a", "b", "c", "d"]
