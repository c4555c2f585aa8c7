"""Every class of objects in singular and plural, and every location, of real folders that nobody has tuned to."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from annotations.generation.entity_check import entity_problems
from annotations.language.plans import Lookup, Named
from annotations.language.texts import article, plural, spellings
from annotations.language.world import Ontology, choose_files, read_competition
from parser_service.parsers.interface import Knowledge
from parser_service.parsers.oracle import GrammarOracle
from tests.annotations.exchange.test_competition_world import (
    NAMED,
    categories,
    constants,
    grounded,
    heads,
    ontology,
    predicates,
)
from tests.annotations.language.published import SHARED

FOLDERS = sorted(
    {
        path.parent.parent
        for above in ("competition-real", "competition-heard", "competition-2025")
        for path in (SHARED / above).rglob("objects.md")
    }
)
pytestmark = [
    pytest.mark.skipif(not FOLDERS, reason=f"there is no folder of a competition in {SHARED}"),
    pytest.mark.parametrize("folder", FOLDERS, ids=lambda each: each.name),
]
BINS = ("trash", "garbage", "rubbish", "bin", "wastebasket")


@cache
def entities_of(folder: Path) -> Ontology:
    paths = choose_files(path.relative_to(folder).as_posix() for path in folder.rglob("*.md")).paths
    files = {place: (folder / path).read_bytes() for place, path in paths.items()}
    kept = [each for each in ontology().entities if each.entity_class not in NAMED]
    return replace(ontology(), entities=(*read_competition(files)[0].entities, *kept))


@cache
def oracle_of(folder: Path) -> GrammarOracle:
    return GrammarOracle(knowledge=Knowledge(ontology=entities_of(folder), grammar=categories()))


def understood(folder: Path, said: str) -> tuple[str, list[str]]:
    """The heads and the constants of the one form that the words have."""
    (form,) = grounded(oracle_of(folder), said)
    return " ".join(heads(form)), constants(form)


def singular_of(world: Ontology, category: str) -> str:
    """The singular that the folder gives; where it gives none to a plural, what it is the plural of."""
    declared = world.singular(category)
    if declared != category:
        return declared
    return next((each for each in spellings(category) if plural(each) == category), category)


def test_every_class_is_understood_in_the_singular_and_in_the_plural(folder):
    world = entities_of(folder)
    room, place = world.texts_of("room")[0], world.texts_of("location")[-1]
    assert world.texts_of("category")
    for category in world.texts_of("category"):
        one = singular_of(world, category)
        a = f"{article(one)} {one}"
        for said, wanted in {
            f"bring me {a}": ("bring", [one]),
            f"find {a} in the {room}": ("find", [one, room]),
            f"get {a} from the {place}": ("take", [one, place]),
            f"what is the biggest {one} on the {place}": ("say", [one, place]),
        }.items():
            assert understood(folder, said) == wanted, said
        for many in {category, plural(one)}:
            for said, wanted in {
                f"how many {many} are there in the {room}": ("say", [category, room]),
                f"how many {many} are on the {place}": ("say", [category, place]),
                f"count the {many}": ("say", [category]),
            }.items():
                assert understood(folder, said) == wanted, said


def test_every_location_is_where_something_is_comes_from_and_is_put(folder):
    world = entities_of(folder)
    thing, person = world.texts_of("object")[0], world.texts_of("name")[0]
    for place in world.texts_of("location"):
        for said, wanted in {
            f"put the {thing} on the {place}": ("put", [thing, place]),
            f"take the {thing} and place it in the {place}": ("take put", [thing, place]),
            f"take the {thing} from the {place}": ("take", [thing, place]),
            f"find {person} at the {place}": ("find", [person, place]),
            f"go to the {place}": ("go", [place]),
            f"throw the {thing} in the {place}": ("put", [thing, place]),
        }.items():
            assert understood(folder, said) == wanted, said


def test_a_word_for_the_trash_is_a_place_where_there_is_one(folder):
    world = entities_of(folder)
    thing = world.texts_of("object")[0]
    lookup = Lookup(world, predicates())
    bins = {
        each.casefold()
        for each in world.texts_of("location")
        if any(word in each.casefold() for word in ("trash", "garbage", "rubbish", "waste"))
    }
    warned = any(
        "trash" in each.message for each in entity_problems(categories(), world, predicates())
    )
    assert warned == (not bins)
    for word in BINS:
        heads_said, (what, where) = understood(folder, f"throw the {thing} in the {word}")
        assert (heads_said, what, where) == ("put", thing, word)
        places = {each.text for each in lookup.places_called(word)}
        with_the_word = {each for each in bins if word in each.replace(" ", "")}
        exact = {each for each in bins if word in each.split()} if word == "bin" else with_the_word
        assert {each.casefold() for each in places} == (exact or bins)
        value, is_missing = lookup.value(word, "put", 1)
        assert is_missing == (len(places) != 1)
        if len(places) == 1:
            assert isinstance(value, Named) and value.text in places
