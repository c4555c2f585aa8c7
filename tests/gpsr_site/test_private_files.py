"""The database belongs to its owner, also in a folder that others may enter."""

from __future__ import annotations

import sqlite3

from gpsr_site.private_files import make_database_private


def modes(folder):
    return {path.name: oct(path.stat().st_mode & 0o777) for path in folder.iterdir()}


def write(path):
    connection = sqlite3.connect(path)
    connection.execute("PRAGMA journal_mode=WAL")
    connection.execute("CREATE TABLE IF NOT EXISTS t (a)")
    connection.execute("INSERT INTO t VALUES (1)")
    connection.commit()
    return connection


def test_a_new_database_and_what_is_beside_it_are_private(tmp_path):
    tmp_path.chmod(0o755)
    make_database_private(tmp_path / "db.sqlite3")
    connection = write(tmp_path / "db.sqlite3")
    assert modes(tmp_path) == dict.fromkeys(
        ("db.sqlite3", "db.sqlite3-wal", "db.sqlite3-shm"), "0o600"
    )
    connection.close()


def test_an_older_one_is_mended_and_keeps_its_rows(tmp_path):
    connection = write(tmp_path / "db.sqlite3")
    for path in tmp_path.iterdir():
        path.chmod(0o644)
    make_database_private(tmp_path / "db.sqlite3")
    assert set(modes(tmp_path).values()) == {"0o600"}
    assert connection.execute("SELECT count(*) FROM t").fetchone() == (1,)
    connection.close()
