"""Every dialogue comes to an end, whatever is answered."""

from __future__ import annotations

import json
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import read_form
from annotations.language.plans import ATTEMPTS, DialogueState, Phase, progress
from tests.annotations.language.plans.robot import PUT, ROBOT, UNCLEAR, begin

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
        assert DialogueState.from_json(json.loads(json.dumps(state.as_json()))) == state


@given(st.lists(st.tuples(COMMANDS, st.booleans()), min_size=ATTEMPTS, max_size=8))
def test_a_dialogue_takes_only_so_many_utterances(
    utterances: list[tuple[tuple[str, str], bool]],
) -> None:
    state: DialogueState | None = None
    for (text, form), is_sure in utterances[:ATTEMPTS]:
        heard = ROBOT.anonymizer.anonymize(text)
        state = ROBOT.begin(read_form(form), heard, is_sure, before=state)
        if not state.is_over and state.phase is not Phase.REPHRASING:
            confirming = replace(state, phase=Phase.CONFIRMING, slots=())
            state = ROBOT.reply(confirming, "no")
    assert state is not None and state.phase is Phase.CANCELLED
