from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import read_form, to_template
from annotations.language.grounding.dialogue import PATIENCE, Dialogue, Phase, State
from tests.annotations.language.sample_ontology import HOME

ROBOT = Dialogue(HOME, {})
PUT = '(put (λ$1:e (is_a $1 "<object>") (at $1 "<location>")) "<location>")'


def begin(text: str, form: str) -> State:
    return ROBOT.begin(read_form(form), ROBOT.anonymizer.anonymize(text))


def talk(text: str, form: str, *answers: str) -> State:
    state = begin(text, form)
    for answer in answers:
        state = ROBOT.reply(state, answer)
    return state


def test_a_command_without_open_slots_is_only_confirmed() -> None:
    state = begin("bring me the tea", '(bring (λ$1:e (is_a $1 "<object>")))')
    assert state.phase is Phase.CONFIRMING
    assert state.prompt == "Shall I bring you the tea?"
    done = ROBOT.reply(state, "Yes, please.")
    assert done.phase is Phase.DONE and done.is_over
    assert to_template(done.form) == '(bring (λ$1:e (is_a $1 "tea")))'


def test_an_open_slot_is_asked_for_with_its_place_in_the_sentence() -> None:
    state = begin("follow", '(follow (λ$1:e (person $1) (name $1 "<name>")))')
    assert state.phase is Phase.ASKING
    assert state.asked is not None and state.asked.entity_class == "name"
    assert state.prompt == "Which name is ___ in “follow the person named ___”? Bo or Ada?"
    after = ROBOT.reply(state, "it is ada")
    assert after.prompt == "Shall I follow the person named Ada?"
    assert after.asked is None


def test_choosing_one_of_two_places_decides_the_other() -> None:
    state = begin("grab the tea on the shelf and put it on the stool", PUT)
    assert state.prompt == (
        "Which location is ___ in “take the tea that is at the ___ and put it on the stool”? "
        "Shelf or stool?"
    )
    after = ROBOT.reply(state, "the stool")
    assert after.phase is Phase.CONFIRMING
    assert '"stool")) "shelf")' in to_template(after.form)


def test_an_unknown_argument_takes_any_text() -> None:
    text, form = "guide Bo", '(guide (λ$1:e (name $1 "<name>")) UNKNOWN)'
    assert '"the old barn")' in to_template(talk(text, form, "the  old barn").form)
    assert '"stool")' in to_template(talk(text, form, "to the stool").form)


def test_an_answer_that_names_nothing_fitting_is_asked_again_and_then_given_up() -> None:
    state = talk("take the tea", PUT, "the moon")
    assert state.phase is Phase.ASKING and state.misses == 1
    assert state.prompt.startswith(
        "I do not know any location called “the moon”. Which location is ___"
    )
    ended = talk("take the tea", PUT, *["the moon"] * PATIENCE)
    assert ended.phase is Phase.CANCELLED
    assert talk("take the tea", PUT, "the moon", "stool").misses == 0


def test_two_entities_in_one_answer_decide_nothing() -> None:
    assert talk("take the tea", PUT, "the stool or the shelf").misses == 1


@pytest.mark.parametrize("word", ["stop", "Cancel!", "never mind"])
def test_a_person_can_stop_at_any_time(word: str) -> None:
    assert talk("take the tea", PUT, word).phase is Phase.CANCELLED
    assert talk("take the tea", PUT, "stool", "shelf", word).phase is Phase.CANCELLED


def test_no_ends_the_dialogue_and_anything_else_asks_for_yes_or_no() -> None:
    text, form = "bring tea", '(bring (λ$1:e (is_a $1 "<object>")))'
    assert talk(text, form, "no").phase is Phase.CANCELLED
    unclear = talk(text, form, "well")
    assert unclear.phase is Phase.CONFIRMING
    assert unclear.prompt == "Please say yes or no. Shall I bring you the tea?"


def test_what_is_not_understood_ends_at_once_and_stays_ended() -> None:
    state = begin("dance", "UNKNOWN")
    assert state.phase is Phase.CANCELLED
    assert ROBOT.reply(state, "yes") == state


ANSWERS = st.lists(
    st.sampled_from(["yes", "no", "stool", "the shelf", "tea", "Bo", "moon", "", "stop", "ada"]),
    max_size=8,
)
COMMANDS = st.sampled_from(
    [
        ("take tea from shelf to stool", PUT),
        ("take it", PUT),
        ("guide somebody", '(guide (λ$1:e (name $1 "<name>")) UNKNOWN)'),
        ("go", '(go "<room>")'),
    ]
)


@given(COMMANDS, ANSWERS)
def test_every_dialogue_is_in_a_state_that_holds_together(
    command: tuple[str, str], answers: list[str]
) -> None:
    state = begin(*command)
    for answer in answers:
        before = state
        state = ROBOT.reply(state, answer)
        assert ROBOT.reply(before, answer) == state
        assert (state.asked is None) == (state.phase is not Phase.ASKING)
        assert state.prompt
        if state.phase in (Phase.CONFIRMING, Phase.DONE):
            assert all(slot.value for slot in state.slots)
        assert State.from_json(json.loads(json.dumps(state.as_json()))) == state
