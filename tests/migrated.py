"""One migrated SQLite database, which the installations that tests start are copies of."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from filelock import FileLock

from tests.annotations.commands.run_command import run_process

DATABASE = "db.sqlite3"


@pytest.fixture(scope="session")
def migrated_database(tmp_path_factory, worker_id) -> Path:
    """The file of a database with all tables and no rows, made by ``migrate``; one for all processes
    of a test run, because making it takes seconds."""
    own = tmp_path_factory.getbasetemp()
    folder = (own if worker_id == "master" else own.parent) / "migrated"
    with FileLock(f"{folder}.lock"):
        if not folder.exists():
            making = own / "migrating"
            migrated = run_process(making, "migrate", "--verbosity", "0")
            assert migrated.returncode == 0, migrated.stderr
            making.rename(folder)
    return folder / DATABASE


@pytest.fixture
def migrated_folder(migrated_database, tmp_path) -> Path:
    """The ``var`` folder of a fresh installation."""
    return copy_installation(migrated_database, tmp_path / "var")


def copy_installation(database: Path, folder: Path) -> Path:
    """Make ``folder`` that of a fresh installation."""
    folder.mkdir(exist_ok=True)
    shutil.copy(database, folder / DATABASE)
    return folder
