"""An upgrade whose tables hold rows of an older version that do not fit: each is named, and nothing is lost."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest

from tests.annotations.commands.run_command import run_process
from tests.migrated import DATABASE

OLDER = (("annotations", "0018"), ("parser_service", "0004"))


@pytest.fixture(scope="module")
def older(tmp_path_factory) -> Path:
    """An installation of an older version with two utterances that do not fit, one of 900 characters and one with
    a NUL."""
    folder = tmp_path_factory.mktemp("older")
    for app, name in OLDER:
        done = run_process(folder, "migrate", app, name, "--verbosity", "0")
        assert done.returncode == 0, done.stderr
    with sqlite3.connect(folder / DATABASE) as connection:
        connection.execute("PRAGMA ignore_check_constraints = ON")
        insert(
            connection,
            "annotations_world",
            {"id": 1, "name": "home", "created_at": "2025-01-01 00:00:00"},
        )
        for key, text in ((7, "é" * 900), (8, "bring\0tea"), (9, "bring tea")):
            insert(connection, "annotations_utterance", {"id": key, "world_id": 1, "text": text})
    return folder


def insert(connection: sqlite3.Connection, table: str, values: dict[str, object]) -> None:
    """Insert a row; its other columns are empty."""
    for _, name, kind, is_needed, default, is_key in connection.execute(
        f"PRAGMA table_info({table})"
    ):
        if is_needed and default is None and not is_key and name not in values:
            is_json = name in ("spans", "sample")
            is_number = kind.split()[0] in ("integer", "bool", "bigint", "smallint")
            is_time = kind == "datetime"
            values[name] = "[]" if is_json else 0 if is_number else "2025-01-01" if is_time else ""
    marks = ", ".join("?" * len(values))
    connection.execute(
        f"INSERT INTO {table} ({', '.join(values)}) VALUES ({marks})", tuple(values.values())
    )


@pytest.mark.processes
def test_an_upgrade_names_the_rows_that_do_not_fit_and_goes_on_once_they_are_mended(older):
    named = ("annotations.utterance, row 7: text has 900", "annotations.utterance, row 8: text has")
    for command in (("migrate",), ("backup", older / "one.zip")):
        done = run_process(older, *command)
        assert done.returncode == 1 and "Traceback" not in done.stderr
        assert all(each in done.stderr for each in named), done.stderr
        assert "row 9" not in done.stderr and "WHERE id = 7" in done.stderr
    assert not (older / "one.zip").exists()
    with sqlite3.connect(older / DATABASE) as connection:
        kept = dict(connection.execute("SELECT id, length(text) FROM annotations_utterance"))
        assert kept[7] == 900
        connection.execute("PRAGMA ignore_check_constraints = ON")
        connection.execute("UPDATE annotations_utterance SET text = 'x' || id WHERE id < 9")
    for command in (("migrate", "--verbosity", "0"), ("backup", older / "one.zip")):
        done = run_process(older, *command)
        assert done.returncode == 0, done.stderr
    assert (older / "one.zip").exists()
