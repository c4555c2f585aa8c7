from __future__ import annotations

import json
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.dialogue import (
    ATTEMPTS,
    PATIENCE,
    Dialogue,
    Offer,
    Phase,
    State,
    progress,
)
from annotations.language.forms import canonical_text, read_form, to_template
from annotations.language.grounding import Anonymizer
from annotations.language.ontology import Entity, Ontology
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.annotations.language.published import SHARED, needs_corpus
from tests.annotations.language.sample_ontology import HOME

ROBOT = Dialogue(HOME, {})
PUT = '(put (λ$1:e (is_a $1 "<object>") (at $1 "<location>")) "<location>")'
BRING = '(bring (λ$1:e (is_a $1 "<object>")))'
UNCLEAR = "grab the tea on the shelf and put it on the stool"


def begin(text: str, form: str, is_sure: bool = True) -> State:
    return ROBOT.begin(read_form(form), ROBOT.anonymizer.anonymize(text), is_sure)


def talk(text: str, form: str, *answers: str) -> State:
    state = begin(text, form)
    for answer in answers:
        state = ROBOT.reply(state, answer)
    return state


def test_a_command_without_open_slots_is_only_confirmed() -> None:
    state = begin("bring me the tea", BRING)
    assert state.phase is Phase.CONFIRMING
    assert state.prompt == "Shall I bring you the tea?"
    done = ROBOT.reply(state, "Yes, please.")
    assert done.phase is Phase.DONE and done.is_over
    assert to_template(done.form) == '(bring (λ$1:e (is_a $1 "tea")))'
    assert to_template(done.parsed) == BRING


def test_an_open_slot_is_asked_for_with_its_place_in_the_sentence() -> None:
    state = begin("follow", '(follow (λ$1:e (person $1) (name $1 "<name>")))')
    assert state.phase is Phase.ASKING
    assert state.asked is not None and state.asked.entity_class == "name"
    assert state.prompt == "Which name is ___ in “follow the person named ___”? Bo or Ada?"
    after = ROBOT.reply(state, "it is ada")
    assert after.prompt == "Shall I follow the person named Ada?"
    assert after.asked is None


def test_choosing_one_of_two_places_decides_the_other() -> None:
    state = begin(UNCLEAR, PUT)
    assert state.prompt == (
        "Which location is ___ in “take the tea that is at the ___ and put it on the stool”? "
        "Shelf or stool?"
    )
    after = ROBOT.reply(state, "the stool")
    assert after.phase is Phase.CONFIRMING
    assert '"stool")) "shelf")' in to_template(after.form)
    assert '"shelf")) "stool")' in to_template(ROBOT.reply(state, "yes").form)


def test_an_unknown_argument_takes_any_text() -> None:
    text, form = "guide Bo", '(guide (λ$1:e (name $1 "<name>")) UNKNOWN)'
    assert '"old barn")' in to_template(talk(text, form, "the  old barn").form)
    assert '"stool")' in to_template(talk(text, form, "to the stool").form)
    assert talk(text, form, "the  old barn").offers == ()


def test_an_unknown_word_is_asked_about_and_learnt_so_that_the_next_command_needs_no_question() -> (
    None
):
    state = begin("bring me the flurb", BRING)
    assert state.prompt == "Which object is “flurb”? Name one that I know, or say “new”."
    for answer in ("new", "it is a flurb", "The flurb!", "It's a new one."):
        after = ROBOT.reply(state, answer)
        assert after.offers == (Offer("object", "flurb"),), answer
        assert after.prompt == "Shall I bring you the flurb?"
    wiser = Dialogue(Ontology((*HOME.entities, Entity("object", "flurb"))), {})
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


def test_answers_that_do_not_fit_are_asked_again_and_then_given_up() -> None:
    assert talk("take the tea", PUT, "tea").prompt.startswith("“tea” is no location. Which")
    assert talk("take the tea", PUT, "stool or shelf").prompt.startswith(
        "Please name one location."
    )
    ended = talk("take the tea", PUT, *["tea"] * PATIENCE)
    assert ended.phase is Phase.CANCELLED
    assert talk("take the tea", PUT, "tea", "stool").misses == 0


@pytest.mark.parametrize(
    "answer", ["", "???", "<location>", "x" * 200, "a\x00b", "it is " + "w " * 20]
)
def test_what_cannot_be_a_name_is_asked_again(answer: str) -> None:
    assert talk("take the tea", PUT, answer).misses == 1


@pytest.mark.parametrize("word", ["stop", "Cancel!", "never mind"])
def test_a_person_can_stop_at_any_time(word: str) -> None:
    assert talk("take the tea", PUT, word).phase is Phase.CANCELLED
    assert talk("take the tea", PUT, "moon", word).phase is Phase.CANCELLED
    assert talk("take the tea", PUT, "stool", "shelf", word).phase is Phase.CANCELLED
    assert talk("dance", "UNKNOWN", word).phase is Phase.CANCELLED


def test_no_asks_for_another_utterance_and_anything_else_for_yes_or_no() -> None:
    refused = talk("bring tea", BRING, "no")
    assert refused.phase is Phase.REPHRASING
    assert refused.prompt == "Then I got it wrong. Please say it another way."
    unclear = talk("bring tea", BRING, "well")
    assert unclear.phase is Phase.CONFIRMING
    assert unclear.prompt == "Please say yes or no. Shall I bring you the tea?"


def test_what_is_not_understood_may_be_said_another_way_a_few_times() -> None:
    state = begin("dance", "UNKNOWN")
    assert state.prompt == "I do not understand that. Please say it another way."
    heard = ROBOT.anonymizer.anonymize("bring tea")
    again = ROBOT.begin(read_form(BRING), heard, before=state)
    assert again.phase is Phase.CONFIRMING
    for _ in range(ATTEMPTS - 1):
        assert state.phase is Phase.REPHRASING
        state = ROBOT.begin(read_form("UNKNOWN"), heard, before=state)
    assert state.phase is Phase.CANCELLED
    assert ROBOT.reply(state, "yes") == state


def test_what_the_parser_is_not_sure_of_is_checked_first() -> None:
    state = begin("take the tea", PUT, is_sure=False)
    assert (
        state.prompt
        == "Did you mean: take the tea that is at the location and put it on the location?"
    )
    assert ROBOT.reply(state, "yes").phase is Phase.ASKING
    assert ROBOT.reply(state, "no").phase is Phase.REPHRASING


def test_an_or_is_settled_by_a_choice_of_what_it_joins() -> None:
    text = "bring me the tea or the small dish"
    state = begin(text, BRING)
    assert state.prompt == "Which object is ___ in “bring me the ___”? Tea or small dish?"
    assert '"small dish"' in to_template(ROBOT.reply(state, "the small dish please").form)
    for answer in ("yes", "either one", "It doesn't matter."):
        after = ROBOT.reply(state, answer)
        assert (after.phase, after.offers) == (Phase.CONFIRMING, ()), answer
        assert '"tea"' in to_template(after.form)
    unnamed = talk(text, BRING, "the cookies")
    assert '"cookies"' in to_template(unnamed.form)
    assert talk("take the tea", PUT, "either").misses == 1


def test_an_unknown_word_in_an_or_can_be_chosen_and_is_learnt() -> None:
    state = begin("bring me the tea or the flurb", BRING)
    assert state.prompt == "Which object is ___ in “bring me the ___”? Tea or “flurb”?"
    for answer in ("the flurb", "new"):
        after = ROBOT.reply(state, answer)
        assert after.offers == (Offer("object", "flurb"),)
        assert '"flurb"' in to_template(after.form)
    assert ROBOT.reply(state, "the tea").offers == ()


def test_a_room_may_be_the_answer_where_the_utterance_offers_one() -> None:
    place = '(put (λ$1:e (is_a $1 "<object>")) "<location>")'
    state = begin("put the tea on the shelf or in the attic", place)
    assert state.prompt.endswith("Shelf or attic?")
    assert to_template(ROBOT.reply(state, "in the attic").form).endswith('"attic")')
    assert ROBOT.reply(state, "in the tea room").phase is Phase.ASKING


def test_one_answer_settles_all_slots_of_a_choice() -> None:
    form = (
        '(sequence (open (λ$1:e (is_a $1 "<object>"))) '
        '(clean (λ$1:e (is_a $1 "<object>"))) (close (λ$1:e (is_a $1 "<location>"))))'
    )
    state = begin("open the tea or the knife at the shelf or the stool", form)
    slots = tuple(replace(each, likely=None) for each in state.slots)
    first = replace(slots[0], candidates=("tea", "knife"), is_choice=True)
    shared = replace(state, slots=(first, replace(first, path=slots[1].path), slots[2]))
    after = ROBOT.reply(shared, "knife")
    assert [slot.value for slot in after.slots] == ["knife", "knife", None]
    assert after.prompt.endswith("Shelf or stool?")


ANSWERS = st.one_of(
    st.sampled_from(
        [
            "yes",
            "no",
            "stool",
            "the shelf",
            "tea",
            "Bo",
            "moon",
            "new",
            "",
            "stop",
            "ada",
            "flurb",
            "either",
        ]
    ),
    st.text(max_size=12),
)
COMMANDS = st.sampled_from(
    [
        (UNCLEAR, PUT),
        ("take it", PUT),
        ("bring the flurb to the glim", PUT),
        ("guide somebody", '(guide (λ$1:e (name $1 "<name>")) UNKNOWN)'),
        ("go", '(go "<room>")'),
        ("dance", "UNKNOWN"),
        ("take the tea or the flurb from the shelf or the attic to the stool or shelf", PUT),
    ]
)


@given(COMMANDS, st.booleans(), st.lists(ANSWERS, max_size=10))
def test_every_answer_brings_a_dialogue_closer_to_its_end(
    command: tuple[str, str], is_sure: bool, answers: list[str]
) -> None:
    state = begin(*command, is_sure)
    for answer in answers:
        before = state
        state = ROBOT.reply(state, answer)
        assert ROBOT.reply(before, answer) == state
        assert state.is_over or progress(state) < progress(before)
        assert (state.asked is None) == (state.phase not in (Phase.ASKING, Phase.LEARNING))
        assert state.prompt
        if state.phase in (Phase.CONFIRMING, Phase.DONE):
            assert all(slot.value for slot in state.slots)
        assert State.from_json(json.loads(json.dumps(state.as_json()))) == state


@given(st.lists(st.tuples(COMMANDS, st.booleans()), min_size=ATTEMPTS, max_size=8))
def test_a_dialogue_takes_only_so_many_utterances(
    utterances: list[tuple[tuple[str, str], bool]],
) -> None:
    state: State | None = None
    for (text, form), is_sure in utterances[:ATTEMPTS]:
        heard = ROBOT.anonymizer.anonymize(text)
        state = ROBOT.begin(read_form(form), heard, is_sure, before=state)
        if not state.is_over and state.phase is not Phase.REPHRASING:
            confirming = replace(state, phase=Phase.CONFIRMING, slots=())
            state = ROBOT.reply(confirming, "no")
    assert state is not None and state.phase is Phase.CANCELLED


@needs_corpus
def test_the_examples_of_the_paper() -> None:
    """Walker et al. 2019, §3.1 to §3.3, in the house of 2018."""
    ontology, _ = read_ontology_folder(SHARED / "generator-2018")
    robot = Dialogue(ontology, {})
    anonymizer = Anonymizer(ontology)
    heard = anonymizer.anonymize("Fetch an apple from the kitchen")
    assert heard.text == "Fetch an <object> from the <room>"  # rooms have a token of their own

    named = "Navigate to the kitchen, look for the apple, and give it to Bill"
    bring = (
        '(bring (λ$1:e (is_a $1 "<object>") (at $1 "<room>")) '
        '(λ$1:e (person $1) (name $1 "<name>")))'
    )
    state = robot.begin(read_form(bring), anonymizer.anonymize(named))
    assert state.asked is not None and state.asked.phrases == ("Bill",)  # 2018 knows no Bill
    state = robot.reply(state, "Bill")
    assert state.offers == (Offer("name", "Bill"),)
    done = robot.reply(state, "yes")
    assert canonical_text(done.form) == canonical_text(
        read_form(
            '(bring (λ$1:e (is_a $1 "apple") (at $1 "kitchen")) (λ$1:e (person $1) (name $1 "Bill")))'
        )
    )

    moved = "Move the apple from the counter to the dining table"
    state = robot.begin(read_form(PUT), anonymizer.anonymize(moved))
    assert state.phase is Phase.CONFIRMING
    assert to_template(state.form) == (
        '(put (λ$1:e (is_a $1 "apple") (at $1 "counter")) "dining table")'
    )

    umbrella = robot.begin(read_form(BRING), anonymizer.anonymize("Bring an umbrella to me"))
    assert umbrella.prompt.startswith("Which object is “umbrella”?")
