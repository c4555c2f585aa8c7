"""A world that is no household sees no word of one: its pages speak of its own commands, or of none."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import pytest
from django.urls import get_resolver
from django.urls.resolvers import URLPattern

from annotations.generation.generating import generate_pairs
from annotations.models import Predicate, World
from annotations.rows.from_rows import recipe_book_of
from tests.greenhouse import PREDICATES, fill_greenhouse

HOUSEHOLD = (
    *("kitchen", "living room", "bedroom", "hallway", "sofa", "apple", "cola", "coke", "drinks"),
    *("mug", "umbrella", "bring me", "pick_up", "find_person", "introduce"),
)


def addresses(patterns: Sequence[Any], before: str = "") -> Iterator[str]:
    for each in patterns:
        at = before + str(each.pattern)
        if isinstance(each, URLPattern):
            yield at
        else:
            yield from addresses(each.url_patterns, at)


PAGES = sorted(
    {
        at
        for at in addresses(get_resolver().url_patterns)
        if at.startswith("w/<") and at.count("<") == 1
    }
)


@pytest.fixture
def greenhouse(db):
    world = World(name="green")
    world.is_bare = True
    world.save()
    fill_greenhouse(world)
    Predicate.objects.filter(world=world).delete()
    for each in PREDICATES.values():
        signatures = [list(map(str, one.arguments)) for one in each.signatures]
        Predicate.objects.create(
            world=world, name=each.name, kind=each.kind, signatures=signatures, gloss=each.gloss
        )
    generate_pairs(world)
    return world


def test_the_pages_of_a_greenhouse_have_no_word_of_a_household(greenhouse, client, superuser):
    client.force_login(superuser)
    seen, found = 0, []
    for at in PAGES:
        answer = client.get("/" + re.sub("<.*?>", greenhouse.name, at))
        if answer.status_code != 200 or "html" not in answer["Content-Type"]:
            continue
        seen += 1
        main = answer.content.decode().partition("<main")[2].lower()
        found += [(at, word) for word in HOUSEHOLD if re.search(rf"\b{word}\b", main)]
    assert seen > 40 and not found


def test_a_world_has_of_the_shipped_recipes_those_of_its_actions(greenhouse):
    names = {each.pattern.action for each in recipe_book_of(greenhouse).recipes}
    assert names and not names & {"bring", "find", "greet"}
