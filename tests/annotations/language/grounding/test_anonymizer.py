from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.grounding import Anonymizer
from annotations.language.grounding.anonymizer import Anonymized
from annotations.language.world import Entity, Ontology
from tests.annotations.language.sample_ontology import HOME

PLAIN = Anonymizer(HOME)
NUMBERED = Anonymizer(HOME, numbered=True)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("bring me the tea", "bring me the <object>"),
        ("BRING Tea to BO", "BRING <object> to <name>"),
        ("the bread knife, not the knife", "the <object>, not the <object>"),
        ("go to the tea room", "go to the <room>"),
        ("go to the tea  room", "go to the <room>"),
        ("two cuppas and a cuppa", "two <object> and a <object>"),
        ("knives, dishes, small dishes", "<object>, dishes, <object>"),
        ("a cookie", "a <object>"),
        ("the shelves", "the <location>"),
        ("toy or toys", "<category> or <category>"),
        ("a drink among drinks", "a <object> among <category>"),
        ("Bo's knife", "<name>'s <object>"),
        ("the teapot and the steam", "the teapot and the steam"),
        ("someone waving their hand tells a joke", "someone <gesture> tells <whattosay>"),
        ("answer a question", "answer a <question>"),
        ("what is up?", "<question>"),
        ("bring <object> to the <room>", "bring <object> to the <room>"),
        ("", ""),
    ],
)
def test_entities_become_tokens_by_the_longest_match(text: str, expected: str) -> None:
    assert PLAIN.anonymize(text).text == expected


def test_numbers_keep_tokens_of_a_class_apart_and_repetitions_together() -> None:
    anonymized = NUMBERED.anonymize(
        "put the tea on the shelf, the knife on the stool, the cuppa away"
    )
    assert anonymized.text == (
        "put the <object0> on the <location0>, the <object1> on the <location1>, the <object0> away"
    )


def test_a_span_says_what_it_replaced() -> None:
    (tea, shelf) = PLAIN.anonymize("Tea on the shelf").spans
    assert (tea.start, tea.end, tea.token, tea.value) == (0, 3, "<object>", "tea")
    assert tea.entity == HOME.of_class("object")[0] and tea.others == ()
    assert (shelf.start, shelf.end) == (11, 16)
    assert [shelf.entity, *shelf.others] == list(HOME.of_class("location")[:2])


def test_the_word_for_any_object_of_a_category_keeps_what_it_said() -> None:
    (span,) = PLAIN.anonymize("a Drink").spans
    assert (span.token, span.value, span.entity.text) == ("<object>", "drink", "drinks")


def test_an_exact_text_wins_over_an_alias_and_an_alias_over_a_plural() -> None:
    ontology = Ontology(
        (
            Entity("object", "glass"),
            Entity("location", "glasses"),
            Entity("room", "bar", ("mug",)),
            Entity("object", "mugs"),
            Entity("name", "Bar"),
        )
    )
    assert Anonymizer(ontology).anonymize("glasses glass mug mugs bar").text == (
        "<location> <object> <room> <object> <name>"
    )


def test_the_command_is_written_as_generated_commands_are() -> None:
    anonymized = PLAIN.anonymize("Go to the attic,  find Bo")
    assert anonymized.text == "Go to the <room>,  find <name>"
    assert anonymized.command == "Go to the <room> , find <name>"


def restore(anonymized: Anonymized) -> str:
    """The original, put together again from the anonymized text and the words of the spans."""
    text = anonymized.text
    for span in anonymized.spans:  # left to right, so what stands before is the original already
        words = anonymized.original[span.start : span.end]
        text = text[: span.start] + words + text[span.start + len(span.token) :]
    return text


@given(
    st.lists(
        st.sampled_from(["tea", "Bread Knife", "attic", "Bo", " ", ",", "x", "<room>", "s", "'"])
    )
)
def test_restoring_gives_every_text_back(pieces: list[str]) -> None:
    text = " ".join(pieces) + "".join(pieces)
    assert restore(PLAIN.anonymize(text)) == text
    assert restore(NUMBERED.anonymize(text)) == text


def test_an_empty_ontology_finds_nothing() -> None:
    assert Anonymizer(Ontology()).anonymize("bring tea").text == "bring tea"
