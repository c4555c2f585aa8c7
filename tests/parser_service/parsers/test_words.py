import pytest

from parser_service.parsers.words import words


@pytest.mark.parametrize(
    ("utterance", "expected"),
    [
        ("Bring me the <object>, please.", ("bring", "me", "the", "<object>", "please")),
        ("What's in Tom’s room?", ("what's", "in", "tom’s", "room")),
        ("'hello'", ("hello",)),
        ("", ()),
        ("?!", ()),
    ],
)
def test_an_utterance_is_cut_into_lower_case_words(utterance, expected):
    assert words(utterance) == expected
