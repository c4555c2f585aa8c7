import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.plans import Islands, cut, cut_at_joints, last_clause, without_clause
from annotations.language.texts import JOINTS

GO, TAKE, GREET = "go to the galley", "take the cup and bring it to me", "greet Ann"


def knows(*commands):
    known = {each.casefold() for each in commands}
    return lambda pieces: [0.0 if each.casefold() in known else None for each in pieces]


JUDGE = knows(GO, TAKE, GREET)


def texts_of(said, judge=JUDGE):
    return tuple(each.text for each in cut_at_joints(said, judge))


def islands_of(said, *commands):
    found = (match.span() for each in commands for match in re.finditer(re.escape(each), said))
    return Islands(frozenset(found))


def cut_out(said, *commands):
    """Return the pieces of a text in which a grammar knows ``commands``; those not understood after a "!"."""
    pieces = cut(said, islands_of(said, *commands))
    return [each.text if each.is_understood else f"! {each.text}" for each in pieces]


@pytest.mark.parametrize(
    "between", [". ", " and ", "; once that is over, ", " now my other wish: ", "\n2. "]
)
def test_what_lies_between_two_commands_is_dropped(between):
    assert cut_out(f"{GO}{between}{GREET}", GO, GREET) == [GO, GREET]


def test_the_fewest_commands_that_cover_most_words_are_taken():
    parts = ("take the cup", "bring it to me", "the cup and bring it")
    assert cut_out(f"{TAKE}. {GO}", TAKE, GO, *parts) == [TAKE, GO]


def test_a_sentence_may_end_inside_a_command_where_a_part_of_it_is_none():
    whole = "fetch the cup. Then bring it to me"
    islands = Islands(islands_of(said := f"{GO}. {whole}.", GO, whole).spans, frozenset({(28, 31)}))
    assert [each.text for each in cut(said, islands)] == [GO, whole]


def test_a_sentence_that_ends_inside_a_name_ends_nowhere():
    meet = "greet Dr. Ann"
    said = f"{meet}. {GO}."
    islands = Islands(islands_of(said, meet, GO).spans, frozenset({(6, 13)}))
    assert [each.text for each in cut(said, islands)] == [meet, GO]


def test_what_may_be_a_command_is_a_piece_of_its_own():
    said = f"{GO}. Polish the glasses. {GREET}"
    assert cut_out(said, GO, GREET) == [GO, "! Polish the glasses", GREET]
    said = f"{GO}, fetch water, {GREET}"
    islands = Islands(islands_of(said, GO, GREET).spans, frozenset(), frozenset({"fetch"}))
    assert [each.text for each in cut(said, islands)] == [GO, "fetch water", GREET]


@pytest.mark.parametrize(
    "said",
    [f"{GO} unless it rains. {GREET}.", f"if it rains, {GO}. {GREET}.", f"don't {GO}. {GREET}."],
)
def test_what_is_held_back_is_not_understood(said):
    held, greet = cut_out(said, GO, GREET)
    assert held == f"! {said.partition('.')[0]}" and greet == GREET


@pytest.mark.parametrize(
    "said", [f"I wonder how to {GO}", f"{GO} or {GREET}", f"{GO}, I am tired", "I am tired"]
)
def test_what_is_no_order_comes_back_whole(said):
    assert cut_out(said, GO, GREET) == [f"! {said}"]


@given(st.text(max_size=40), st.data())
def test_pieces_lie_in_the_text_in_order(text, data):
    places = st.integers(0, len(text))
    spans = st.frozensets(st.tuples(places, places).filter(lambda each: each[0] < each[1]))
    islands = Islands(data.draw(spans), data.draw(spans))
    end = 0
    for piece in cut(text, islands):
        assert end <= piece.start <= piece.end <= len(text)
        assert piece.text == text[piece.start : piece.end]
        end = piece.end


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
    assert [each.casefold() for each in texts_of(said)] == [
        GO,
        TAKE,
        GREET.casefold(),
    ]


def test_a_command_with_joints_inside_stays_whole():
    assert texts_of(TAKE) == (TAKE,)
    assert texts_of(f"{TAKE}, then {GO}") == (TAKE, GO)


def test_what_is_not_understood_is_a_piece_between_joints():
    said = f"{GO} and then open the door. {TAKE}"
    pieces = cut_at_joints(said, JUDGE)
    assert [(each.text, each.is_understood) for each in pieces] == [
        (GO, True),
        ("open the door", False),
        (TAKE, True),
    ]
    assert texts_of("open the door and then sit down") == ("open the door and then sit down",)


def test_more_commands_than_a_robot_takes_come_back_whole():
    four = f"{GO}. {GO}. {GO}. {GO}."
    assert texts_of(four) == (four,)


def test_fewer_commands_count_more_and_better_ones_among_as_many():
    scores = {"a": -1.0, "b. c": -9.0, "a. b": -2.0, "c": -1.0, "b": -0.1}

    def judge(pieces):
        return [scores.get(each) for each in pieces]

    assert texts_of("a. b. c", judge) == ("a. b", "c")


@given(st.text(alphabet="ab .,;1)", max_size=60) | st.lists(st.sampled_from(JOINTS)).map(" ".join))
def test_any_text_is_cut_or_comes_back(text):
    assert texts_of(text, knows()) == (text,)
    everything = texts_of(text, lambda pieces: [None if each == text else 0.0 for each in pieces])
    assert 1 <= len(everything) <= 3


@pytest.mark.parametrize(
    ("said", "clause"),
    [
        ("bring me the cup and polish it", "polish it"),
        ("bring me the cup, and then polish it please", "polish it please"),
        ("water the roses and sing", "sing"),
        ("bring me the cup and a plate", ""),
        ("bring me the cup and that is all", ""),
        ("bring me the salt and pepper", ""),
        ("bring me the cup", ""),
        ("and", ""),
        ("", ""),
    ],
)
def test_the_clause_that_is_said_last_has_a_verb_of_its_own(said, clause):
    at = said.find("salt and pepper")
    found = last_clause(said, {(at, len(said))} if at >= 0 else ())
    assert (found.text if found else "") == clause
    if found:
        assert said[found.start : found.end] == clause
        assert without_clause(said, found) == said.split(" and")[0].rstrip(",")


@given(st.text(alphabet="ab ,.and'", max_size=60))
def test_what_stands_before_a_clause_is_not_empty(text):
    found = last_clause(text)
    assert found is None or text[found.start : found.end] == found.text
