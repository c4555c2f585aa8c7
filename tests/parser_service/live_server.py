"""The parse server in a thread of the test, which shares its database."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from functools import partial
from typing import Any

import pytest
from waitress import wasyncore
from waitress.server import create_server

from parser_service.serving.application import ParseApplication
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import Shelf
from tests.waiting import PATIENCE_SECONDS


@pytest.fixture
def parse_server(settings) -> Iterator[Shelf]:
    """Serves what is on the shelf; the test updates it. Runs that are not promoted cannot be loaded,
    since threads do not see what the test has written."""
    shelf = Shelf(10_000_000, Metrics())
    application = ParseApplication(shelf, settings.PARSER_SECRET, lambda: None)
    sockets: dict[int, Any] = {}
    server = create_server(application, sockets, host="127.0.0.1", port=0, threads=2)
    settings.PARSER_URL = f"http://127.0.0.1:{server.effective_port}"
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    yield shelf
    server.task_dispatcher.shutdown()
    # In the thread of the loop, which would look at sockets that another one has closed.
    server.trigger.pull_trigger(partial(wasyncore.close_all, sockets))
    thread.join(PATIENCE_SECONDS)
