"""One migrated SQLite database, which the installations that tests start are copies of."""

from __future__ import annotations

import os
import shutil
from hashlib import sha256
from pathlib import Path

import django
import pytest
from django.apps import apps
from filelock import FileLock

from tests.annotations.commands.run_command import run_process

DATABASE = "db.sqlite3"


@pytest.fixture(scope="session")
def migrated_database(pytestconfig, tmp_path_factory, worker_id) -> Path:
    """The file of a database with all tables and no rows, made by ``migrate``. Making it takes seconds: it is
    made once for all processes of a test run, and kept in pytest's cache while the migrations stay the same."""
    own = tmp_path_factory.getbasetemp()
    if cache := getattr(pytestconfig, "cache", None):
        folder = cache.mkdir("migrated")
    else:
        folder = own if worker_id == "master" else own.parent
    kept = folder / f"{_digest_of_migrations()}.sqlite3"
    with FileLock(f"{kept}.lock"):
        if not kept.exists():
            migrated = run_process(own / "migrating", "migrate", "--verbosity", "0")
            assert migrated.returncode == 0, migrated.stderr
            part = shutil.copy(own / "migrating" / DATABASE, f"{kept}.part")
            os.replace(part, kept)  # whole, even if this process is killed
    return kept


def _digest_of_migrations() -> str:
    digest = sha256(django.__version__.encode())
    for app in apps.get_app_configs():
        for path in sorted(Path(app.path).glob("migrations/*.py")):
            digest.update(f"\n{app.label} {path.name}\n".encode() + path.read_bytes())
    return digest.hexdigest()


@pytest.fixture
def migrated_folder(migrated_database, tmp_path) -> Path:
    """The ``var`` folder of a fresh installation."""
    return copy_installation(migrated_database, tmp_path / "var")


def copy_installation(database: Path, folder: Path) -> Path:
    """Make ``folder`` that of a fresh installation."""
    folder.mkdir(exist_ok=True)
    shutil.copy(database, folder / DATABASE)
    return folder
