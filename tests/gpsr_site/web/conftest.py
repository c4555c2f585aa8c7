"""The real web server in a thread of the test, on the test's database."""

from __future__ import annotations

import socket
import threading
import urllib.error
import urllib.request
from dataclasses import dataclass

import pytest
from django.db import connections

from gpsr_site.web import server as web_server
from gpsr_site.web.server import WebServer
from gpsr_site.wsgi import application
from tests.waiting import PATIENCE_SECONDS


@dataclass(frozen=True)
class Site:
    """Where the server listens."""

    port: int

    def status(self, path: str) -> int:
        """The status of an answer; TimeoutError where none comes."""
        try:
            address = f"http://127.0.0.1:{self.port}{path}"
            with urllib.request.urlopen(address, timeout=PATIENCE_SECONDS) as answer:
                return answer.status
        except urllib.error.HTTPError as error:
            return error.code

    def connect(self, sent: bytes) -> socket.socket:
        """A connection that has sent this much."""
        connection = socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE_SECONDS)
        connection.sendall(sent)
        return connection

    def answer_to(self, sent: bytes) -> bytes:
        """What comes back for ``sent`` until the server closes."""
        with self.connect(sent) as connection:
            answer = b""
            while piece := connection.recv(65536):
                answer += piece
            return answer


@pytest.fixture
def site(transactional_db, monkeypatch) -> Site:
    monkeypatch.setitem(connections.settings["default"], "CONN_MAX_AGE", 0)
    # Longer than a test waits: what a test expects is never the server's own giving up.
    monkeypatch.setattr(web_server, "ARRIVAL_SECONDS", 2 * PATIENCE_SECONDS)
    monkeypatch.setattr(web_server, "IDLE_SECONDS", 2 * PATIENCE_SECONDS)
    monkeypatch.setattr(web_server, "DISCARD_SECONDS", 2 * PATIENCE_SECONDS)
    server = WebServer(application, "127.0.0.1", 0)
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    yield Site(server.port)
    server.stop()
    thread.join(10)
