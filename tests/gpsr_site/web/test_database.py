"""A PostgreSQL that is slow or away does not hold the threads of the web server."""

from __future__ import annotations

import pytest
from django.db import OperationalError, connection, connections

from gpsr_site.web import database
from gpsr_site.web.error_pages import is_outage


@pytest.fixture
def postgres(transactional_db):
    if connection.vendor != "postgresql":
        pytest.skip("needs PostgreSQL (TEST_DATABASE_URL)")
    return connection


def test_pages_bound_their_statements_and_wait_for_no_lock_for_ever(postgres, monkeypatch):
    options = {**connections.settings["default"]["OPTIONS"]}
    monkeypatch.setitem(connections.settings["default"], "OPTIONS", options)
    monkeypatch.setattr(database, "STATEMENT_SECONDS", 1)
    database.bound_statements()
    fresh = connections.create_connection("default")
    with fresh.cursor() as cursor:
        cursor.execute("SHOW lock_timeout")
        assert cursor.fetchone() == ("10s",)
        with pytest.raises(OperationalError) as caught:
            cursor.execute("SELECT pg_sleep(600)")
    fresh.close()
    assert is_outage(caught.value)


def test_a_database_that_is_away_is_known_within_seconds(postgres):
    assert connections.settings["default"]["OPTIONS"]["connect_timeout"] == 5
