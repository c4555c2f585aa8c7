"""A PostgreSQL that is slow, hangs or is away does not hold the threads of the web server."""

from __future__ import annotations

import socket
import threading

import psycopg
import pytest
from django.db import OperationalError, connection, connections
from django.test import RequestFactory

from gpsr_site.web import database
from gpsr_site.web.deadlines import Deadline
from gpsr_site.web.error_pages import is_outage


@pytest.fixture
def postgres(transactional_db):
    if connection.vendor != "postgresql":
        pytest.skip("needs PostgreSQL (TEST_DATABASE_URL)")
    return connection


class Wire:
    """Carries bytes between a client and PostgreSQL until it is cut: then it stays open and silent."""

    def __init__(self, host: str, port: int) -> None:
        self.there = (host, port)
        self.is_cut = threading.Event()
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self) -> None:
        while True:
            try:
                here, _ = self.listener.accept()
            except OSError:
                return
            there = socket.create_connection(self.there)
            for source, target in ((here, there), (there, here)):
                threading.Thread(target=self.carry, args=(source, target), daemon=True).start()

    def carry(self, source: socket.socket, target: socket.socket) -> None:
        while data := source.recv(65536):
            if not self.is_cut.is_set():
                target.sendall(data)


@pytest.fixture
def wire(postgres):
    parameters = postgres.get_connection_params()
    wire = Wire(parameters.get("host") or "127.0.0.1", int(parameters.get("port") or 5432))
    yield wire
    wire.listener.close()


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


def test_a_database_that_hangs_frees_the_thread(wire, postgres, settings):
    settings.REQUEST_SECONDS = 2
    parameters = postgres.get_connection_params()
    names = ("dbname", "user", "password")
    chosen = {name: parameters[name] for name in names if parameters.get(name)}

    def view(request):
        client = psycopg.connect(host="127.0.0.1", port=wire.port, **chosen)
        wire.is_cut.set()
        client.execute("SELECT 1")

    assert Deadline(view)(RequestFactory().get("/")).status_code == 503
