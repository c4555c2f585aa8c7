"""Fixtures that any test may ask for: the real files, worlds, people with roles, their browsers."""

from __future__ import annotations

import gc
import os
import shutil
import signal
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import hypothesis
import pytest
from django.conf import settings as site
from django.contrib.contenttypes.management import create_contenttypes
from django.core.cache import cache
from django.db import connection
from django.db.models.signals import post_migrate
from django.test import Client, override_settings
from hypothesis import HealthCheck

from annotations.background import leasing
from annotations.models import ApiToken, Membership, Scope, User, World
from annotations.models.worlds import Role
from tests.replaying import made_once
from tests.sample_world import SampleWorld, fill_world
from tests.waiting import PATIENCE_SECONDS
from tests.write_transactions import Lasted, measured_transactions

ROOT = Path(__file__).resolve().parent.parent

gc.disable()  # Django is loaded; until the tests are collected: what is collected stays

# The same examples in every run, however slow the machine; --hypothesis-profile=search looks for others.
STEADY = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
hypothesis.settings.register_profile("steady", max_examples=60, derandomize=True, **STEADY)
hypothesis.settings.register_profile("search", max_examples=2_000, **STEADY)
hypothesis.settings.load_profile("steady")

# The markers of tests that mostly wait.
WAITING = {"processes", "browser"}


LISTEN_EVERY = leasing.LISTEN_EVERY
LASTED = pytest.StashKey[list[Lasted]]()


def pytest_configure(config: pytest.Config) -> None:
    """Sets up what holds for all tests, since a fixture costs in each.

    Processes that tests start obey Ctrl-C also where these were started in the background of a script, whose
    shell has it ignored. Static files have no manifest, so that pages render unbuilt. A hasher costs nothing.
    Downloads have no line, since a test's client seldom reads one to its end. Django would write rows about all
    models again, permissions above all, whenever a test's database is emptied; nothing here reads them.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    post_migrate.disconnect(create_contenttypes)
    post_migrate.disconnect(dispatch_uid="django.contrib.auth.management.create_permissions")
    plain = {"BACKEND": "django.contrib.staticfiles.storage.StaticFilesStorage"}
    shares = "gpsr_site.web.thread_shares.ThreadShares"
    stack = ExitStack()
    config.add_cleanup(stack.close)
    config.stash[LASTED] = stack.enter_context(measured_transactions())
    stack.enter_context(
        override_settings(
            MIDDLEWARE=[each for each in site.MIDDLEWARE if each != shares],
            STORAGES={**site.STORAGES, "staticfiles": plain},
            PASSWORD_HASHERS=["django.contrib.auth.hashers.MD5PasswordHasher"],
        )
    )


def pytest_collection_finish() -> None:
    """Thousands of modules and tests stay to the end: the garbage collector need not visit them. What
    a test makes is few megabytes: it need not come often either."""
    gc.freeze()
    gc.set_threshold(100_000, 20, 100)
    gc.enable()


@pytest.hookimpl(wrapper=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> Iterator[None]:
    """Marks what touches a database, so that it can be run once more on another one. Then moves files
    with tests that mostly wait to the front: begun last, they would leave processors idle in the end."""
    for item in items:
        fixtures = set(getattr(item, "fixturenames", ()))
        if fixtures & {"db", "transactional_db"} or item.get_closest_marker("django_db"):
            item.add_marker("services")
    yield
    waiting = {item.path for item in items if WAITING & {mark.name for mark in item.iter_markers()}}
    items.sort(key=lambda item: (item.path not in waiting, item.path))


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """The thread of a lease has its own connection, to which work inside a test's transaction looks lost: it
    looks only at what is committed."""
    mark = item.get_closest_marker("django_db")
    is_committed = "transactional_db" in getattr(item, "fixturenames", ()) or (
        mark and mark.kwargs.get("transaction")
    )
    leasing.LISTEN_EVERY = LISTEN_EVERY if is_committed else PATIENCE_SECONDS
    item.config.stash[LASTED].clear()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item: pytest.Item) -> Iterator[None]:
    """A write transaction that computes keeps all others from writing; it has to be short."""
    yield
    assert not [each for each in item.config.stash[LASTED] if each.is_too_long], (
        "compute before the transaction, and only write in it"
    )


@pytest.fixture
def transactional_db(transactional_db):
    """What is counted in the shared cache is rolled back with the test; but for committed data."""
    cache.clear()


@pytest.fixture(scope="session")
def django_db_modify_db_settings(django_db_modify_db_settings_parallel_suffix, request):
    """SQLite's test database is a file, which the workers and servers of a test can open too: a copy
    of one that is migrated."""
    database = connection.settings_dict
    if connection.vendor == "sqlite":
        database["TEST"]["NAME"] = str(site.VAR_DIR / "test.sqlite3")
        shutil.copy(request.getfixturevalue("migrated_database"), database["TEST"]["NAME"])


@pytest.fixture(scope="session")
def django_db_keepdb(request) -> bool:
    """Whether the database that is there is used; SQLite's was copied a moment ago."""
    return connection.vendor == "sqlite" or request.config.getvalue("reuse_db")


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of real generator files and published pairs; the test is skipped without it."""
    folder = Path(os.environ.get("GPSR_SHARED_DATA") or ROOT.parent / "shared" / "data")
    if not (folder / "generator-2018").is_dir():
        pytest.skip(f"needs the real files (GPSR_SHARED_DATA), and {folder} does not hold them")
    return folder


@pytest.fixture
def world(db) -> World:
    return World.objects.create(name="home", description="A flat with one robot.")


@pytest.fixture
def sample(world) -> SampleWorld:
    """``world`` with something of every kind in it."""
    return made_once(fill_world, world)


@pytest.fixture
def other_world(db) -> World:
    """A world in which only ``stranger`` has a role."""
    return World.objects.create(name="laboratory")


@pytest.fixture
def other_sample(other_world) -> SampleWorld:
    return made_once(fill_world, other_world)


def member(world: World, name: str, role: Role) -> User:
    user = User.objects.create_user(name, password="correct horse")
    Membership.objects.create(world=world, user=user, role=role)
    return user


@pytest.fixture
def annotator(world) -> User:
    return member(world, "anna", Role.ANNOTATOR)


@pytest.fixture
def reviewer(world) -> User:
    return member(world, "rene", Role.REVIEWER)


@pytest.fixture
def admin(world) -> User:
    """An admin of ``world``, who is nobody elsewhere."""
    return member(world, "adam", Role.ADMIN)


@pytest.fixture
def stranger(other_world) -> User:
    """An admin of ``other_world``, who is nobody in ``world``."""
    return member(other_world, "stina", Role.ADMIN)


@pytest.fixture
def anna(annotator) -> Client:
    """A browser in which the annotator is logged in."""
    return client_of(annotator)


@pytest.fixture
def rene(reviewer) -> Client:
    """A browser in which the reviewer is logged in."""
    return client_of(reviewer)


@pytest.fixture
def adam(admin) -> Client:
    """A browser in which the admin is logged in."""
    return client_of(admin)


def client_of(user: User) -> Client:
    client = Client()
    client.force_login(user)
    return client


@pytest.fixture
def superuser(db) -> User:
    return User.objects.create_superuser("root", password="correct horse")


@pytest.fixture
def call_as(client):
    """A function: the answer to a request below ``/api/v1/`` with a fresh token of ``user``.

    ``data`` is sent as JSON, ``files`` as a form; further names are headers.
    """

    def send(user, method, path, data=None, files=None, scope=Scope.ADMIN, **headers):
        _, key = ApiToken.issue(user, "notebook", scope=scope)
        headers = {name.replace("_", "-"): value for name, value in headers.items()}
        headers["authorization"] = f"Bearer {key}"
        options = {} if files else {"content_type": "application/json"}
        address = f"/api/v1/{path}"
        return getattr(client, method)(address, files or data, headers=headers, **options)

    return send
