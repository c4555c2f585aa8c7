"""Plurals of nouns."""

from __future__ import annotations

import pytest

from annotations.language.english import plural, say_count


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
