"""An upgrade whose tables hold rows of an older version that do not fit: each is named, and nothing is lost."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator

import pytest

from tests.gpsr_site.upgrading.installation import Installation, installed
from tests.migrated import DATABASE

# As the table of an installation holds them that was made before SQLite's tables had limits.
COPY = (
    "CREATE TEMP TABLE copied AS SELECT * FROM annotations_campaign",
    "UPDATE copied SET id = 7, name = 'long', completion_code = printf('%900d', 0)",
    "INSERT INTO annotations_campaign SELECT * FROM copied",
    "UPDATE copied SET id = 8, name = 'bad' || char(0), completion_code = ''",
    "INSERT INTO annotations_campaign SELECT * FROM copied",
)


@pytest.fixture
def older(tmp_path) -> Iterator[Installation]:
    """An installation of 7eb91d0 with two campaigns that do not fit, one with a code of 900 characters and one with
    a NUL."""
    with installed("sqlite", tmp_path) as installation:
        change(installation, *COPY)
        yield installation


def change(installation: Installation, *statements: str) -> None:
    with sqlite3.connect(installation.folder / DATABASE) as connection:
        connection.execute("PRAGMA ignore_check_constraints = ON")
        for statement in statements:
            connection.execute(statement)


@pytest.mark.processes
def test_an_upgrade_names_the_rows_that_do_not_fit_and_goes_on_once_they_are_mended(older):
    backup = older.folder / "one.zip"
    named = (
        "annotations.campaign, row 7: completion_code has 900",
        "annotations.campaign, row 8: name",
    )
    for command in (("migrate",), ("backup", backup)):
        done = older.manage(*command)
        assert done.returncode == 1 and "Traceback" not in done.stderr
        assert all(each in done.stderr for each in named), done.stderr
        assert "row 1:" not in done.stderr and "WHERE id = 7" in done.stderr
    assert not backup.exists()
    lengths = "SELECT id, length(completion_code) FROM annotations_campaign"
    assert dict(older.execute(lengths))[7] == 900
    change(
        older, "UPDATE annotations_campaign SET completion_code = '', name = 'x' || id WHERE id > 1"
    )
    for command in (("migrate", "--verbosity", "0"), ("backup", backup)):
        done = older.manage(*command)
        assert done.returncode == 0, done.stderr
    assert backup.exists()
