"""Fixtures that any test may ask for: the real files, a world, and people with roles in it."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest
from django.conf import settings as site
from django.db import connection

from annotations.models import Membership, User, World
from annotations.models.worlds import Role

ROOT = Path(__file__).resolve().parent.parent


def pytest_configure() -> None:
    """Processes that tests start obey Ctrl-C also where these were started in the background of a
    script, whose shell has it ignored."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Marks what touches a database, so that it can be run once more on another one."""
    for item in items:
        fixtures = set(getattr(item, "fixturenames", ()))
        if fixtures & {"db", "transactional_db"} or item.get_closest_marker("django_db"):
            item.add_marker("services")


@pytest.fixture(autouse=True)
def quick_and_plain(settings):
    """Static files without a manifest, so that pages render unbuilt; a hasher that costs nothing."""
    settings.STORAGES = {
        **site.STORAGES,
        "staticfiles": {"BACKEND": "django.contrib.staticfiles.storage.StaticFilesStorage"},
    }
    settings.PASSWORD_HASHERS = ["django.contrib.auth.hashers.MD5PasswordHasher"]


@pytest.fixture(scope="session")
def django_db_modify_db_settings(django_db_modify_db_settings_parallel_suffix):
    """SQLite's test database is a file, which the workers and servers of a test can open too."""
    database = connection.settings_dict
    if connection.vendor == "sqlite" and not database["TEST"]["NAME"]:
        database["TEST"]["NAME"] = str(site.VAR_DIR / "test.sqlite3")


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
def other_world(db) -> World:
    """A world in which only ``stranger`` has a role."""
    return World.objects.create(name="laboratory")


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
def superuser(db) -> User:
    return User.objects.create_superuser("root", password="correct horse")
