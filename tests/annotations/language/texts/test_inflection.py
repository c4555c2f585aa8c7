"""Plurals of nouns."""

from __future__ import annotations

import os
import re
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.exchange.shipped_worlds import SHIPPED_WORLDS
from annotations.language.texts import (
    article,
    definite,
    looks_plural,
    plural,
    say_count,
    singular,
    spellings,
)
from annotations.language.texts.word_lists import NOUNS_IN_IE, PLURALS, SINGULARS_IN_S, UNCHANGING

# What names an object, a location or a class in the files of generators and competitions.
NAMED = re.compile(
    r'\b(?:name|category|alias)="([^"]+)"|^\|[ \d|]*([A-Za-z][\w -]*?)(?: ?\( ?p ?\))? *\|', re.M
)
FILES = ("objects.xml", "locations.xml", "objects.md", "location_names.md")


@cache
def nouns() -> tuple[str, ...]:
    """Return the nouns of all shipped worlds and, where they are, of the shared folders."""
    folders = [world.folder for world in SHIPPED_WORLDS.values()]
    if shared := os.environ.get("GPSR_SHARED_DATA"):
        folders.append(Path(shared))
    texts = (
        path.read_text("utf-8", "ignore")
        for folder in folders
        for path in sorted(folder.rglob("*"))
        if path.name.lower() in FILES
    )
    found = {
        " ".join(each).replace("_", " ").strip() for text in texts for each in NAMED.findall(text)
    }
    listed = {*PLURALS, *NOUNS_IN_IE, *SINGULARS_IN_S, *UNCHANGING}
    return tuple(sorted(found | listed))


def test_there_are_nouns_to_inflect():
    assert len(nouns()) > 150


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
        ("knife", "knives"),
        ("Bookshelf", "Bookshelves"),
        ("cherry tomato", "cherry tomatoes"),
        ("grandchild", "grandchildren"),
        ("fireman", "firemen"),
        ("human", "humans"),
        ("roof", "roofs"),
        ("photo", "photos"),
        ("hoodie", "hoodies"),
        ("TV", "TVs"),
        ("TOMATO", "TOMATOES"),
        ("kiwis", "kiwis"),
        ("lens", "lenses"),
        ("basis", "bases"),
        ("children", "children"),
        ("cutlery", "cutlery"),
        ("tableware", "tableware"),
        ("bottle of water", "bottles of water"),
        ("İ", "İs"),
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
    [
        ("orange shirt", "an"),
        ("cup", "a"),
        ("uniform", "a"),
        ("hour", "an"),
        ("Apple", "an"),
        ("utensil", "a"),
        ("MP3 player", "an"),
        ("USB stick", "a"),
        ("8 ball", "an"),
        ("European plug", "a"),
        ("uninteresting box", "an"),
    ],
)
def test_the_article_of_a_noun_phrase(noun: str, expected: str) -> None:
    assert article(noun) == expected


@pytest.mark.parametrize("noun", ["bed two", "shelf 3", "Gate Ten"])
def test_what_ends_with_its_number_is_a_name_without_an_article(noun: str) -> None:
    assert definite(noun) == noun


@pytest.mark.parametrize("noun", ["tomatoes", "first bed", "two", "7", "bed b"])
def test_other_nouns_have_their_article(noun: str) -> None:
    assert definite(noun) == f"the {noun}"


@pytest.mark.parametrize(
    ("noun", "expected"),
    [
        ("coffee grounds", True),
        ("glass", False),
        ("bus", False),
        ("tea", False),
        ("kiwis", True),
        ("menus", True),
        ("iris", False),
        ("people", True),
        ("knives", True),
        ("series", False),
        ("cans of soup", True),
        ("bottle of chips", False),
    ],
)
def test_a_plural_is_known_by_its_end(noun: str, expected: bool) -> None:
    assert looks_plural(noun) is expected


WORDS = st.sampled_from(nouns()) | st.from_regex(r"[A-Za-z]{2,9}[b-hj-rtv-z]", fullmatch=True)


@given(
    WORDS,
    st.sampled_from(["{}", "red {}", "{} of water", "The {}"]),
    st.sampled_from([str, str.title]),
)
def test_each_plural_that_is_printed_is_known_again_and_the_other_way_round(noun, phrase, write):
    noun = phrase.format(write(noun))
    printed = plural(noun)
    assert plural(printed) == printed
    if printed != noun:
        assert next(spellings(noun)) == printed
        assert noun in spellings(printed)


def test_each_noun_of_the_worlds_is_the_singular_of_its_plural():
    wrong = {
        noun: singular(plural(noun))
        for noun in nouns()
        if not looks_plural(noun) and singular(plural(noun)) not in (noun, plural(noun))
    }
    assert wrong == {}


@pytest.mark.parametrize("noun", sorted(PLURALS))
def test_each_listed_plural_is_understood(noun):
    for form in PLURALS[noun]:
        assert form in spellings(noun)
        assert noun in spellings(form)


@pytest.mark.parametrize(
    ("noun", "said"),
    [
        ("cup", "the cup"),
        ("bed two", "bed two"),
        ("the dry dock", "the dry dock"),
        ("my mug", "my mug"),
    ],
)
def test_a_phrase_has_one_determiner_at_most(noun, said):
    assert definite(noun) == said
