"""Commands that name several entities for a slot, of which the person chooses one."""

from __future__ import annotations

from dataclasses import replace

from annotations.language.forms import to_template
from annotations.language.plans import Offer, Phase
from tests.annotations.language.plans.robot import BRING, PUT, ROBOT, UNCLEAR, begin, talk


def test_choosing_one_of_two_places_decides_the_other() -> None:
    state = begin(UNCLEAR, PUT)
    assert state.prompt == "Where is the tea? Shelf or stool?"
    after = ROBOT.reply(state, "the stool")
    assert after.phase is Phase.CONFIRMING
    assert '"stool")) "shelf")' in to_template(after.form)
    assert '"shelf")) "stool")' in to_template(ROBOT.reply(state, "yes").form)


def test_an_or_is_settled_by_a_choice_of_what_it_joins() -> None:
    text = "bring me the tea or the small dish"
    state = begin(text, BRING)
    assert state.prompt == "What shall I bring you? Tea or small dish?"
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
    assert state.prompt == "What shall I bring you? Tea or “flurb”?"
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
