import pytest

from annotations.language.texts import NearWords, sounds_like

SAME = """
haley hailey, lying line, bowl bull, meat meet, jonathon jonathan, emilie emily, fridge fritch, bored board, pause pose,
read red, steven stephen, sofia sophia, sara sarah, kris chris, jon john, wait weight, brian bryan, geoff jeff,
sale sail
"""
OTHERS = """
jake jack, cop cup, let lead, maria mary, daniel danielle, michael michelle, bowl ball, full follow, jane jade,
make take, grab crab, lucas luke, emma emily, mike mick, lene lena
"""


def pairs(text):
    return [tuple(pair.split()) for pair in text.replace("\n", " ").split(",")]


@pytest.mark.parametrize(("one", "other"), pairs(SAME))
def test_words_that_sound_alike(one, other):
    assert sounds_like(one, other)
    assert sounds_like(other, one)
    assert [near.word for near in NearWords([other, "zebra"]).near(one) if near.is_sure] == [other]


@pytest.mark.parametrize(("one", "other"), pairs(OTHERS))
def test_words_that_do_not(one, other):
    assert not sounds_like(one, other)
    assert not sounds_like(other, one)


def test_a_typo_is_near_by_its_letters_and_a_word_by_its_sound_alone():
    words = NearWords(["kitchen", "take", "drinks", "cookie"])
    assert [(near.word, near.kind) for near in words.near("kitchne")] == [("kitchen", "spelling")]
    assert not [near for near in words.near("make") if near.is_sure]
    assert [(near.word, near.kind) for near in words.near("drink")] == [("drinks", "inflection")]
    assert not [near for near in words.near("rookie") if near.is_sure]


def test_words_that_tie_others_together_are_heard_as_few_others():
    words = NearWords(["to", "form", "from", "there", "their", "in", "on", "an"])
    assert {near.word for near in words.near("too")} == {"to"}
    assert {near.word for near in words.near("from")} == {"form"}
    assert {near.word for near in words.near("there")} == {"their"}
    assert not words.near("in")
