"""Plurals of nouns."""

from __future__ import annotations

import pytest

from annotations.language.english import article, looks_plural, plural, say_count


@pytest.mark.parametrize(
    ("noun", "expected"),
    [
        ("object", "objects"),
        ("person", "people"),
        ("dish", "dishes"),
        ("box of the category", "boxes of the category"),
        ("toy", "toys"),
        ("berry", "berries"),
        ("glass", "glasses"),
        ("bus", "buses"),
        ("tools", "tools"),
        ("cleaning products", "cleaning products"),
        ("drinks of the house", "drinks of the house"),
    ],
)
def test_the_plural_of_a_noun_phrase(noun: str, expected: str) -> None:
    assert plural(noun) == expected


def test_a_count_is_said_with_its_noun() -> None:
    assert [say_count(count, "match") for count in (0, 1, 2000)] == [
        "0 matches",
        "1 match",
        "2,000 matches",
    ]


@pytest.mark.parametrize(
    ("noun", "expected"),
    [("orange shirt", "an"), ("cup", "a"), ("uniform", "a"), ("hour", "an"), ("Apple", "an")],
)
def test_the_article_of_a_noun_phrase(noun: str, expected: str) -> None:
    assert article(noun) == expected


@pytest.mark.parametrize(
    ("noun", "expected"),
    [("coffee grounds", True), ("glass", False), ("bus", False), ("tea", False)],
)
def test_a_plural_is_known_by_its_end(noun: str, expected: bool) -> None:
    assert looks_plural(noun) is expected
