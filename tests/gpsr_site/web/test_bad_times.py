"""What people are told when the disk is full or the database is damaged: what is known, and what to do."""

from __future__ import annotations

import html
import json
from io import StringIO
from pathlib import Path

import pytest
from django.core.cache import cache
from django.core.management import call_command
from django.core.management.base import CommandError
from django.db import DatabaseError, OperationalError, connection, connections
from django.test import RequestFactory

import annotations
from annotations.background.failures import (
    DAMAGED,
    FREE_SPACE,
    MAKE_WRITABLE,
    database_sentence,
    failure_sentence,
    is_damaged,
    is_disk_full,
)
from annotations.models import Utterance, World
from annotations.people.rate_limits import JOINING, STARTED_RUNS
from gpsr_site.sqlite.base import DatabaseWrapper
from gpsr_site.web.error_pages import is_outage, server_error

STARTER = Path(annotations.__file__).parent / "starter" / "household"


@pytest.fixture
def full_database(transactional_db):
    """Let SQLite's own limit of pages be reached: it answers as on a full disk."""
    if connection.vendor != "sqlite":
        pytest.skip("fills SQLite")
    world = World.objects.create(name="full")

    def fill():
        with connection.cursor() as cursor:
            cursor.execute("PRAGMA max_page_count = 1")  # SQLite takes the present number instead
        for count in (500, 1):  # what earlier tests have left free, then the last page
            with pytest.raises(OperationalError):
                for number in range(1_000):
                    texts = (f"{count} {number} {each} {'x' * 400}" for each in range(count))
                    Utterance.objects.bulk_create(
                        Utterance(world=world, text=each) for each in texts
                    )

    yield fill
    with connection.cursor() as cursor:
        cursor.execute("PRAGMA max_page_count = 1073741823")


@pytest.fixture
def damaged_error(tmp_path, django_db_blocker):
    """The error of a SQLite file in which a page was overwritten."""
    path = tmp_path / "damaged.sqlite3"
    django_db_blocker.unblock()
    database = DatabaseWrapper(
        {**connections.settings["default"], "NAME": str(path), "OPTIONS": {}}
    )
    with database.cursor() as cursor:
        cursor.execute("CREATE TABLE said (text TEXT)")
        cursor.executemany("INSERT INTO said VALUES (%s)", [("x" * 200,)] * 500)
    database.close()
    content = bytearray(path.read_bytes())
    content[4096 * 2 : 4096 * 8] = b"\xff" * (4096 * 6)
    path.write_bytes(content)
    with pytest.raises(DatabaseError) as caught, database.cursor() as cursor:
        cursor.execute("SELECT count(text), max(text) FROM said")
        cursor.fetchall()
    database.close()
    django_db_blocker.restore()
    return caught.value


def answer_to(error: BaseException, path: str = "/"):
    """What the site answers where ``error`` has reached it."""
    try:
        raise error
    except BaseException:
        return server_error(RequestFactory().get(path))


def test_a_full_disk_refuses_what_is_saved_and_shows_what_is_read(full_database, admin_client):
    admin_client.raise_request_exception = False
    cache.set("kept", 1, timeout=-1)
    full_database()
    path = "/api/v1/worlds/full/utterances/"
    texts = ("go to the kitchen " * 20 + str(number) for number in range(100))
    answers = (
        admin_client.post(path, {"texts": [text]}, content_type="application/json")
        for text in texts
    )
    refused = next(answer for answer in answers if answer.status_code != 201)
    assert refused.status_code == 507 and "Retry-After" not in refused.headers
    assert FREE_SPACE in json.loads(refused.content)["detail"]
    assert cache.get("kept") is None
    assert cache.get_or_set("large", lambda: "x" * 100_000) == "x" * 100_000
    for path in ("/", "/healthz", "/w/full/", "/w/full/utterances/", "/account/"):
        assert admin_client.get(path).status_code == 200, path


@pytest.fixture
def read_only_database(transactional_db):
    """Let the connection refuse to write."""
    if connection.vendor != "sqlite":
        pytest.skip("asks SQLite")

    def close():
        with connection.cursor() as cursor:
            cursor.execute("PRAGMA query_only = 1")

    yield close
    with connection.cursor() as cursor:
        cursor.execute("PRAGMA query_only = 0")


@pytest.mark.django_db(transaction=True)
@pytest.mark.parametrize("disk", ["full_database", "read_only_database"])
def test_a_disk_that_cannot_be_written_is_no_limit_that_somebody_has_reached(
    disk, request, client, django_user_model
):
    spoil = request.getfixturevalue(disk)
    django_user_model.objects.create_user("carla", password="right-password-1")
    client.raise_request_exception = False
    spoil()
    answers = [
        client.post("/login/", {"username": "carla", "password": "right-password-1"}),
        *(client.post("/join/none/", {}) for _ in range(2)),
    ]
    # A full database has place for a session now and then.
    assert answers[0].status_code in ([507, 302] if disk == "full_database" else [507])
    assert 429 not in [answer.status_code for answer in answers]
    for rate in (JOINING, STARTED_RUNS):
        with pytest.raises(OperationalError):
            for number in range(1_000):  # a full database may still have place for some
                assert rate.take(str(number)) is not None
    if disk == "read_only_database":
        assert MAKE_WRITABLE in html.unescape(answers[0].content.decode())


def test_a_database_that_was_stopped_in_order_is_read_from_a_read_only_disk(
    tmp_path, monkeypatch, django_db_blocker
):
    options = {"init_command": "PRAGMA journal_mode=WAL;", "transaction_mode": "IMMEDIATE"}
    given = {**connections.settings["default"], "NAME": str(tmp_path / "db"), "OPTIONS": options}
    with django_db_blocker.unblock():
        writing = DatabaseWrapper(given)
        with writing.cursor() as cursor:
            cursor.execute("CREATE TABLE said (text TEXT)")
        writing.close()
        assert [path.name for path in tmp_path.iterdir()] == ["db"]
        (tmp_path / "db-shm").mkdir()  # as on a read-only disk, none can be made
        monkeypatch.setattr("gpsr_site.sqlite.base.os.access", lambda *_: False)
        reading = DatabaseWrapper(given)
        with reading.cursor() as cursor:
            assert cursor.execute("SELECT * FROM said").fetchall() == []
            with pytest.raises(DatabaseError) as caught:
                cursor.execute("INSERT INTO said VALUES ('hello')")
        reading.close()
    assert MAKE_WRITABLE in failure_sentence(caught.value)


def test_a_command_on_a_full_disk_says_what_to_free(full_database):
    full_database()
    with pytest.raises(CommandError) as caught:
        call_command("import_generator", str(STARTER), world="new", stdout=StringIO())
    assert FREE_SPACE in str(caught.value) and "migrate" not in str(caught.value)


def test_what_somebody_said_about_a_full_disk_is_no_full_disk(db):
    world = World.objects.create(name="full")
    with pytest.raises(DatabaseError) as caught:
        for _ in range(2):
            Utterance.objects.create(world=world, text="No space left on device: the disk is full")
    assert not is_disk_full(caught.value)


def test_a_damaged_database_names_restore(damaged_error):
    assert is_damaged(damaged_error) and not is_disk_full(damaged_error)
    assert not is_outage(damaged_error)
    answer = answer_to(damaged_error)
    assert answer.status_code == 500 and "restore FILE" in answer.content.decode()
    problem = json.loads(answer_to(damaged_error, "/api/v1/worlds/").content)
    assert problem["detail"] == DAMAGED
    assert database_sentence(damaged_error) == failure_sentence(damaged_error) == DAMAGED


def test_migrate_is_named_where_a_table_is_missing_and_nowhere_else(db):
    with pytest.raises(DatabaseError) as caught, connection.cursor() as cursor:
        cursor.execute("SELECT * FROM no_such_table")
    assert "migrate" in database_sentence(caught.value)
    assert "migrate" not in database_sentence(DatabaseError("database is locked"))
