"""Words that the ontology does not have: as values of UNKNOWN, learnt, or as other words for what is known."""

from __future__ import annotations

import pytest

from annotations.language.forms import read_form, to_template
from annotations.language.plans import DialogueManager, Offer, Phase
from annotations.language.world import Entity, Ontology
from tests.annotations.language.plans.robot import BRING, PUT, ROBOT, begin, talk
from tests.annotations.language.sample_ontology import HOME


def test_an_unknown_argument_takes_any_text() -> None:
    text, form = "guide Bo", '(guide (λ$1:e (name $1 "<name>")) UNKNOWN)'
    assert '"old barn")' in to_template(talk(text, form, "the  old barn").form)
    assert '"stool")' in to_template(talk(text, form, "to the stool").form)
    assert talk(text, form, "the  old barn").offers == ()


def test_an_unknown_word_is_asked_about_and_learnt_so_that_the_next_command_needs_no_question() -> (
    None
):
    state = begin("bring me the flurb", BRING)
    assert (
        state.prompt == "Which object do you mean by “flurb”? Name one that I know, or say “new”."
    )
    for answer in ("new", "it is a flurb", "The flurb!", "It's a new one."):
        after = ROBOT.reply(state, answer)
        assert after.offers == (Offer("object", "flurb"),), answer
        assert after.prompt == "Shall I bring you the flurb?"
    wiser = DialogueManager(Ontology((*HOME.entities, Entity("object", "flurb"))), {})
    heard = wiser.anonymizer.anonymize("bring me the flurb")
    assert wiser.begin(read_form(BRING), heard).phase is Phase.CONFIRMING


def test_an_unknown_word_may_be_another_word_for_something_known() -> None:
    after = talk("bring me the flurb", BRING, "that is the tea")
    assert '"tea"' in to_template(after.form)
    assert after.offers == (Offer("object", "tea", "flurb"),)


def test_an_answer_that_nobody_knows_is_learnt_if_the_person_agrees() -> None:
    asked = talk("take the tea", PUT, "the moon")
    assert asked.phase is Phase.LEARNING
    assert asked.prompt == "I do not know any location called “moon”. Shall I learn it?"
    assert '"moon"' in to_template(ROBOT.reply(asked, "yes").form)
    assert ROBOT.reply(asked, "yes").offers == (Offer("location", "moon"),)
    refused = ROBOT.reply(asked, "no")
    assert refused.phase is Phase.ASKING and refused.misses == 1
    assert refused.offers == ()


@pytest.mark.parametrize(
    "answer", ["", "???", "<location>", "x" * 200, "a\x00b", "it is " + "w " * 20]
)
def test_what_cannot_be_a_name_is_asked_again(answer: str) -> None:
    assert talk("take the tea", PUT, answer).misses == 1


MOVE = '(put (λ$1:e (is_a $1 "<object>")) "<location>")'
TWO_THINGS = '(sequence (open (λ$1:e (is_a $1 "<object>"))) (clean (λ$1:e (is_a $1 "<object>"))))'


@pytest.mark.parametrize("answer", ["new", "the flurb", "that is the tea", "it is a flapdoodle"])
def test_a_word_that_is_settled_is_offered_for_no_other_slot(answer: str) -> None:
    asked = talk("put the flurb away", MOVE, answer)
    if asked.phase is Phase.LEARNING:
        asked = ROBOT.reply(asked, "yes")
    assert asked.asked is not None and asked.asked.phrases == ()
    assert "“flurb”" not in asked.prompt
    assert asked.prompt.endswith("Shelf or stool?")


def test_of_two_unknown_words_the_second_slot_is_offered_the_one_that_is_left() -> None:
    asked = begin("open the flurb and clean the glim", TWO_THINGS)
    assert asked.prompt.startswith("Which object do you mean by “flurb” or “glim”?")
    for answer in ("new", "the flurb"):
        after = ROBOT.reply(asked, answer)
        assert after.prompt.startswith("Which object do you mean by “glim”?"), answer
    other_way = ROBOT.reply(asked, "the glim")
    assert other_way.prompt.startswith("Which object do you mean by “flurb”?")
    unsettled = ROBOT.reply(asked, "the tea")  # for either word
    assert unsettled.prompt.startswith("Which object do you mean by “flurb” or “glim”?")


def test_an_unknown_word_behind_a_preposition_of_place_is_a_place_and_no_thing() -> None:
    asked = begin("bring the flurb to the glim", MOVE)
    assert asked.prompt.startswith("Which object do you mean by “flurb”?")
    after = ROBOT.reply(asked, "the tea")
    assert after.prompt.startswith("Which location do you mean by “glim”?")


def test_an_unknown_argument_settles_a_word_too() -> None:
    asked = talk("put the flurb", '(put UNKNOWN (λ$1:e (is_a $1 "<object>")))', "the flurb")
    assert asked.prompt.startswith("What shall I put the flurb on?")


def test_an_or_keeps_its_unknown_words_from_other_slots() -> None:
    asked = talk("take the tea or the flurb away", MOVE, "the tea")
    assert asked.prompt.endswith("Shelf or stool?") and "flurb" not in asked.prompt


def test_a_word_that_was_learnt_is_known_when_it_is_said_again() -> None:
    learnt = talk("open and clean the flurb", TWO_THINGS, "new")
    done = ROBOT.reply(learnt, "the Flurb")
    assert done.phase is Phase.CONFIRMING
    assert done.offers == (Offer("object", "flurb"),)
    assert to_template(done.form).count('"flurb"') == 2
    alias = talk("open and clean the flurb", TWO_THINGS, "the tea", "flurb")
    assert alias.phase is Phase.CONFIRMING
    assert to_template(alias.form).count('"tea"') == 2
