"""A generator small enough to read, for tests that store things."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pytest

from annotations.exchange.generator_import import import_generator
from annotations.models import Campaign, World
from tests.launched_campaigns import fill_household, launch_in
from tests.replaying import made_once

TINY = {
    "common_rules.txt": "; grammar name Common\n$vbfind = find | locate\n$object = {kobject}\n",
    "tiny_category_1_grammar.txt": (
        "; import common.txt\n$Main = $vbfind the $object\n$Main = go to the {room}\n"
    ),
    "tiny_category_1_semantics.txt": (
        "# What to find, where to go\n"
        "$vbfind the $object = (find (λ$1:e (is_a $1 $object)))\n"
        "go to the {room} = (go {room})\n"
    ),
    "objects.xml": (
        '<categories><category name="drinks" room="kitchen">\n'
        '<object name="tea"/>\n<object name="milk" type="alike"/>\n</category></categories>'
    ),
    "locations.xml": (
        '<rooms>\n<room name="kitchen"><location name="sink" isPlacement="true"/></room>\n'
        '<room name="bath"><location name="sink" isPlacement="true"/></room>\n</rooms>'
    ),
}


def as_bytes(files):
    return {
        name: text if isinstance(text, bytes) else text.encode() for name, text in files.items()
    }


@pytest.fixture
def tiny() -> dict[str, bytes]:
    """The files of a generator with one task category, four commands and two forms."""
    return as_bytes(TINY)


@pytest.fixture
def tiny_folder(tmp_path, tiny):
    for name, data in tiny.items():
        (tmp_path / name).write_bytes(data)
    return tmp_path


@pytest.fixture
def tiny_world(world) -> World:
    """``world`` with the tiny generator in it."""
    return made_once(import_tiny, world)


def import_tiny(world: World) -> World:
    assert not import_generator(world.name, as_bytes(TINY)).problems
    return world


@pytest.fixture
def household(world) -> World:
    """``world`` with the grammar, entities and commands of the starter world, without paraphrases."""
    return made_once(fill_household, world)


@pytest.fixture
def launched(household, admin) -> Callable[..., Campaign]:
    """Launches a campaign: columns of ``Campaign``, and ``choice`` for those of ``PromptChoice``."""
    return partial(launch_in, household, admin)
