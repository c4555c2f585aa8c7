from __future__ import annotations

import threading
from wsgiref.simple_server import WSGIRequestHandler, make_server

import pytest

from annotations.models import ApiToken
from parser_service.runs.promoting import promote
from parser_service.serving.application import ParseApplication
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import Shelf
from tests.parser_service.served import make_home, trained_run


class Silent(WSGIRequestHandler):
    def log_message(self, *_args):
        pass


@pytest.fixture
def shelf(world):
    """A nearest neighbour that is promoted in ``world``, in memory."""
    promote(trained_run(make_home(world)), None)
    made = Shelf(10_000_000, Metrics())
    made.update()
    return made


@pytest.fixture
def parse_server(shelf, settings):
    """The parse server's application on a port of its own, to which the site points."""
    application = ParseApplication(shelf, settings.PARSER_SECRET, lambda: None)
    server = make_server("127.0.0.1", 0, application, handler_class=Silent)
    settings.PARSER_URL = f"http://127.0.0.1:{server.server_port}"
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    yield shelf
    server.shutdown()
    thread.join()
    server.server_close()


@pytest.fixture
def call(client):
    """Returns a function that sends a request to REST as somebody."""

    def send(user, path, data=None, scope="annotate", **headers):
        _, key = ApiToken.issue(user, "robot", scope=scope)
        headers["authorization"] = f"Bearer {key}"
        if data is None:
            return client.get(path, headers=headers)
        return client.post(path, data, content_type="application/json", headers=headers)

    return send
