"""Two sample worlds that the tests of a module share; what a test changes in them is rolled back."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import deepcopy

import pytest
from django.conf import settings
from django.db import connection, transaction
from django.test import Client

from annotations.models import User, World
from annotations.models.worlds import Role
from tests.conftest import client_of, member
from tests.gpsr_site.routes.addresses import KEYS
from tests.replaying import made_once
from tests.sample_world import SampleWorld, fill_world


@pytest.fixture(scope="module")
def filled_worlds(django_db_setup, django_db_blocker) -> Iterator[tuple[SampleWorld, SampleWorld]]:
    """Fill two worlds in a transaction around those of the module's tests, which are savepoints in it.

    SQLite reads its schema anew after each rollback of a transaction that has made a table, and filling
    a world makes temporary ones: it is done before, in a transaction of its own, and only repeated here.
    """
    with django_db_blocker.unblock():
        if connection.vendor == "sqlite":
            with transaction.atomic():
                make_worlds()
                transaction.set_rollback(True)
        block = transaction.atomic()
        block.__enter__()
        worlds = make_worlds()
    yield worlds
    with django_db_blocker.unblock():
        transaction.set_rollback(True)
        block.__exit__(None, None, None)


def make_worlds() -> tuple[SampleWorld, SampleWorld]:
    home, laboratory = (World.objects.create(name=name) for name in ("home", "laboratory"))
    return made_once(fill_in_full, home), made_once(fill_in_full, laboratory)


def fill_in_full(world: World) -> SampleWorld:
    """Put something of every kind into an empty world, and every row that a route is about."""
    sample = fill_world(world)
    for make_rows in KEYS.values():
        make_rows(sample)
    return sample


@pytest.fixture(scope="module")
def logged_in_people(filled_worlds, django_db_blocker) -> dict[str, tuple[User, str]]:
    """Everybody of the policy but the anonymous, with the key of a session of theirs."""
    home, laboratory = (sample.world for sample in filled_worlds)
    with django_db_blocker.unblock():
        people = {
            "annotator": member(home, "anna", Role.ANNOTATOR),
            "reviewer": member(home, "rene", Role.REVIEWER),
            "admin": member(home, "adam", Role.ADMIN),
            "stranger": member(laboratory, "stina", Role.ADMIN),
            "superuser": User.objects.create_superuser("root", password="correct horse"),
        }
        return {
            person: (user, client_of(user).cookies[settings.SESSION_COOKIE_NAME].value)
            for person, user in people.items()
        }


@pytest.fixture
def client_as(logged_in_people, db) -> Callable[[str], Client]:
    """Makes a browser in which a person of the policy is logged in, or nobody."""

    def make(person: str) -> Client:
        client = Client()
        if person != "anonymous":
            client.cookies[settings.SESSION_COOKIE_NAME] = logged_in_people[person][1]
        return client

    return make


@pytest.fixture
def annotator(logged_in_people, db) -> User:
    return deepcopy(logged_in_people["annotator"][0])


@pytest.fixture
def admin(logged_in_people, db) -> User:
    return deepcopy(logged_in_people["admin"][0])


@pytest.fixture
def superuser(logged_in_people, db) -> User:
    return deepcopy(logged_in_people["superuser"][0])


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


@pytest.fixture
def reviewer(logged_in_people, db) -> User:
    return deepcopy(logged_in_people["reviewer"][0])
