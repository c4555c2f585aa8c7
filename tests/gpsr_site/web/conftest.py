"""The real web server in a thread of the tests, on their database."""

from __future__ import annotations

import socket
import threading
import urllib.error
import urllib.request
from typing import Any

import pytest
import waitress
from django.core.wsgi import get_wsgi_application
from django.db import connections

from gpsr_site import settings as as_served
from gpsr_site.web.server import OPTIONS, listen
from tests.waiting import PATIENCE_SECONDS


class Site:
    """A server that nothing can stop, so one does for all tests; each says what ``application`` it serves."""

    application: Any

    def __init__(self) -> None:
        (listening,) = listen("127.0.0.1", 0)
        self.port: int = listening.getsockname()[1]
        # A client may be slower than the server has patience for: what a test expects is never its giving up.
        options = OPTIONS | {"sockets": [listening], "channel_timeout": 2 * PATIENCE_SECONDS}
        serving = threading.Thread(
            target=waitress.serve, args=[self.answer], kwargs=options, daemon=True
        )
        serving.start()

    def answer(self, environ, start_response):
        return self.application(environ, start_response)

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


@pytest.fixture(scope="session")
def server() -> Site:
    return Site()


@pytest.fixture
def site(server, transactional_db, monkeypatch, settings) -> Site:
    settings.MIDDLEWARE = as_served.MIDDLEWARE
    monkeypatch.setitem(connections.settings["default"], "CONN_MAX_AGE", 0)
    server.application = get_wsgi_application()  # with the shares of threads that the test sets
    return server
