import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.english import JOINTS
from annotations.language.requests import cut_commands

GO, TAKE, GREET = "go to the galley", "take the cup and bring it to me", "greet Ann"


def knows(*commands):
    known = {each.casefold() for each in commands}
    return lambda pieces: [0.0 if each.casefold() in known else None for each in pieces]


JUDGE = knows(GO, TAKE, GREET)


@pytest.mark.parametrize(
    "said",
    [
        f"{GO}. {TAKE}. {GREET}.",
        f"{GO} and then {TAKE}, and finally {GREET}",
        f"First {GO}, then {TAKE}, and after that {GREET}.",
        f"1. {GO} 2. {TAKE} 3. {GREET}",
        f"{GO}; also {TAKE}; {GREET}!",
        f"Then {GO}. Second, {TAKE}; finally {GREET}",
        f"I have three tasks for you: {GO}, {TAKE} and {GREET}",
        f"Your first task is to {GO}. Your second task is to {TAKE}. When you are done, {GREET}.",
    ],
)
def test_three_commands_are_found_however_they_are_joined(said):
    assert [each.casefold() for each in cut_commands(said, JUDGE)] == [
        GO,
        TAKE,
        GREET.casefold(),
    ]


def test_a_command_with_joints_inside_stays_whole():
    assert cut_commands(TAKE, JUDGE) == (TAKE,)
    assert cut_commands(f"{TAKE}, then {GO}", JUDGE) == (TAKE, GO)


def test_where_a_piece_is_not_understood_the_utterance_comes_back():
    said = f"{GO} and then open the door"
    assert cut_commands(said, JUDGE) == (said,)
    four = f"{GO}. {GO}. {GO}. {GO}."
    assert cut_commands(four, JUDGE) == (four,)


def test_fewer_commands_count_more_and_better_ones_among_as_many():
    scores = {"a": -1.0, "b. c": -9.0, "a. b": -2.0, "c": -1.0, "b": -0.1}

    def judge(pieces):
        return [scores.get(each) for each in pieces]

    assert cut_commands("a. b. c", judge) == ("a. b", "c")


@given(st.text(alphabet="ab .,;1)", max_size=60) | st.lists(st.sampled_from(JOINTS)).map(" ".join))
def test_any_text_is_cut_or_comes_back(text):
    assert cut_commands(text, knows()) == (text,)
    everything = cut_commands(
        text, lambda pieces: [None if each == text else 0.0 for each in pieces]
    )
    assert 1 <= len(everything) <= 3
