from __future__ import annotations

import pytest

from annotations.language.forms import read_form, to_template
from annotations.language.grounding import NOT_UNDERSTOOD
from annotations.language.plans import ATTEMPTS, PATIENCE, Phase
from tests.annotations.language.plans.robot import BRING, PUT, ROBOT, begin, talk


def test_a_command_without_open_slots_is_only_confirmed() -> None:
    state = begin("bring me the tea", BRING)
    assert state.phase is Phase.CONFIRMING
    assert state.prompt == "Shall I bring you the tea?"
    done = ROBOT.reply(state, "Yes, please.")
    assert done.phase is Phase.DONE and done.is_over
    assert to_template(done.form) == '(bring (λ$1:e (is_a $1 "tea")))'
    assert to_template(done.parsed) == BRING


def test_an_open_slot_is_asked_for() -> None:
    state = begin("follow", '(follow (λ$1:e (person $1) (name $1 "<name>")))')
    assert state.phase is Phase.ASKING
    assert state.asked is not None and state.asked.entity_class == "name"
    assert state.prompt == "Who shall I follow? Bo or Ada?"
    after = ROBOT.reply(state, "it is ada")
    assert after.prompt == "Shall I follow the person named Ada?"
    assert after.asked is None


def test_answers_that_do_not_fit_are_asked_again_and_then_given_up() -> None:
    assert talk("take the tea", PUT, "tea").prompt.startswith("“tea” is no location. Where is")
    assert talk("take the tea", PUT, "stool or shelf").prompt.startswith(
        "Please name one location."
    )
    ended = talk("take the tea", PUT, *["tea"] * PATIENCE)
    assert ended.phase is Phase.CANCELLED
    assert talk("take the tea", PUT, "tea", "stool").misses == 0


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
    assert state.prompt == NOT_UNDERSTOOD
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
