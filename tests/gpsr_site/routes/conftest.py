"""Two sample worlds that the tests of a module share; what a test changes in them is rolled back."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy

import pytest
from django.db import transaction

from annotations.models import World
from tests.gpsr_site.routes.addresses import KEYS
from tests.sample_world import SampleWorld, fill_world


@pytest.fixture(scope="module")
def filled_worlds(django_db_setup, django_db_blocker) -> Iterator[tuple[SampleWorld, SampleWorld]]:
    """Fill two worlds in a transaction around those of the module's tests, which are savepoints in it."""
    with django_db_blocker.unblock():
        block = transaction.atomic()
        block.__enter__()
        worlds = make_world("home"), make_world("laboratory")
    yield worlds
    with django_db_blocker.unblock():
        transaction.set_rollback(True)
        block.__exit__(None, None, None)


def make_world(name: str) -> SampleWorld:
    """Make a world with something of every kind, and every row that a route is about."""
    sample = fill_world(World.objects.create(name=name))
    for make_rows in KEYS.values():
        make_rows(sample)
    return sample


@pytest.fixture
def sample(filled_worlds, db) -> SampleWorld:
    return deepcopy(filled_worlds[0])


@pytest.fixture
def world(sample) -> World:
    return sample.world


@pytest.fixture
def other_sample(filled_worlds, db) -> SampleWorld:
    return deepcopy(filled_worlds[1])


@pytest.fixture
def other_world(other_sample) -> World:
    return other_sample.world
