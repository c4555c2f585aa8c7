"""The parse server in a thread of the test, which shares its database."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest
from waitress.server import create_server

from parser_service.serving.application import Application
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import Shelf


@pytest.fixture
def parse_server(settings) -> Iterator[Shelf]:
    """Serves what is on the shelf; the test updates it. Runs that are not promoted cannot be loaded,
    since threads do not see what the test has written."""
    shelf = Shelf(10_000_000, Metrics())
    application = Application(shelf, settings.PARSER_SECRET, lambda: None)
    server = create_server(application, host="127.0.0.1", port=0, threads=2)
    settings.PARSER_URL = f"http://127.0.0.1:{server.effective_port}"
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    yield shelf
    server.task_dispatcher.shutdown()
    server.close()
