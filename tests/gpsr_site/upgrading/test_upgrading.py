"""An upgrade keeps the rows of 7eb91d0 and ends with the tables of a new installation."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from django.core.management import call_command
from django.db import connection

from tests.gpsr_site.upgrading.installation import Installation, dump_of, installed

# What a table is, but for the order of its columns.
SCHEMA = {
    "sqlite": ["SELECT type, name, tbl_name, sql FROM sqlite_master WHERE name != 'sqlite_stat1'"],
    "postgresql": [
        "SELECT table_name, column_name, data_type, character_maximum_length, is_nullable, column_default,"
        " identity_generation FROM information_schema.columns WHERE table_schema = 'public'",
        "SELECT conrelid::regclass::text, conname, pg_get_constraintdef(oid) FROM pg_constraint"
        " WHERE connamespace = 'public'::regnamespace",
        "SELECT tablename, indexname, indexdef FROM pg_indexes WHERE schemaname = 'public'",
    ],
}
MADE_BY_MIGRATE = {"django_migrations", "sqlite_sequence"}
APPLIED = "SELECT app, name FROM django_migrations"

pytestmark = [pytest.mark.processes, pytest.mark.services]


@pytest.fixture(scope="module")
def upgraded(tmp_path_factory) -> Iterator[Installation]:
    with installed(connection.vendor, tmp_path_factory.mktemp("upgraded")) as installation:
        assert installation.manage("migrate", "--check").returncode == 1
        done = installation.manage("migrate", "--verbosity", "0")
        assert (done.returncode, done.stderr) == (0, "")
        yield installation


def schema(execute: Callable[[str], list[tuple[Any, ...]]]) -> list[list[str]]:
    rows = [row for query in SCHEMA[connection.vendor] for row in execute(query)]
    return sorted([part for value in row for part in parts(str(value))] for row in rows)


def parts(sql: str) -> list[str]:
    """Return the columns and constraints of a table in one order. Django writes the values of an IN in any order, and
    PostgreSQL's dump adds casts and brackets."""
    one_order = re.sub(r"IN \('[^)]*\)", lambda found: str(sorted(found[0][4:-1].split(","))), sql)
    start, _, columns = one_order.partition("(")
    plain = re.sub(r"::(character varying|text)|[()\[\]]", "", columns)
    return [start, *sorted(plain.split(", "))]


def execute_here(query: str) -> list[tuple[Any, ...]]:
    with connection.cursor() as cursor:
        cursor.execute(query)
        return cursor.fetchall()


def test_an_installation_of_7eb91d0_becomes_what_a_new_one_is(upgraded, db):
    assert upgraded.manage("migrate", "--check").returncode == 0
    assert schema(upgraded.execute) == schema(execute_here)
    assert set(upgraded.execute(APPLIED)) == set(execute_here(APPLIED))


def test_an_upgrade_keeps_every_row(upgraded):
    dump = dump_of(connection.vendor)
    before = Counter(re.findall(r"^INSERT INTO (?:public\.)?\"?(\w+)", dump, re.MULTILINE))
    tables = before.keys() - MADE_BY_MIGRATE
    assert {table: upgraded.execute(f"SELECT count(*) FROM {table}")[0][0] for table in tables} == {
        table: before[table] for table in tables
    }
    assert upgraded.execute("SELECT name, contact, minutes FROM annotations_campaign") == [
        ("first", "", None)
    ]


def test_an_upgraded_installation_shows_every_page_and_takes_its_token(upgraded):
    assert upgraded.manage("collectstatic", "--no-input", "--verbosity", "0").returncode == 0
    done = upgraded.python("-m", "tests.gpsr_site.upgrading.visiting")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    assert found["faults"] == {} and found["visited"] > 100


def test_an_installation_from_before_7eb91d0_is_refused(tmp_path):
    with installed(connection.vendor, tmp_path) as older:
        older.execute("DELETE FROM django_migrations WHERE app = 'annotations' AND name > '0018'")
        for command in (("migrate",), ("backup", tmp_path / "one.zip")):
            done = older.manage(*command)
            assert done.returncode == 1 and "Traceback" not in done.stderr, done.stderr
            assert ("7eb91d0" in done.stderr) == (command == ("migrate",))
    assert not (tmp_path / "one.zip").exists()


def test_the_migrations_make_what_the_models_say(db):
    call_command("makemigrations", check_changes=True, dry_run=True, verbosity=0)
