"""The parse server as a process: it listens, and keeps what it holds up to date."""

from __future__ import annotations

import logging
import os
import signal
import sys
import threading

from django.db import connections
from waitress.server import create_server

from parser_service.serving.application import ParseApplication
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import Shelf

logger = logging.getLogger(__name__)

THREADS = 32  # requests that are answered together wait in a thread each
CONNECTIONS = 500
MOST_BODY_BYTES = 2 * 1024 * 1024  # the site takes no more than half of it
LOOK_EVERY = 0.5  # seconds


def serve(host: str, port: int, secret: str, most_bytes: int) -> None:
    """Answer on ``host:port`` until SIGTERM or SIGINT. Raises OSError where it cannot listen there."""
    # Read when torch is loaded. More threads wait for each other wherever something else computes too.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    shelf = Shelf(most_bytes, Metrics())
    server = create_server(
        ParseApplication(shelf, secret, connections.close_all),
        host=host,
        port=port,
        threads=THREADS,
        connection_limit=CONNECTIONS,
        max_request_body_size=MOST_BODY_BYTES,
        ident="",
    )
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    threading.Thread(target=_keep_up, args=[shelf], name="watch", daemon=True).start()
    logger.info("The parse server answers on %s:%s.", host, port)
    server.run()


def _keep_up(shelf: Shelf) -> None:
    """Let the shelf follow the database; what it holds stays while the database is away."""
    is_away = False
    while True:
        try:
            shelf.update()
            is_away = False
        except Exception as error:
            if not is_away:
                logger.warning("The parse server keeps what it has: %s", error)
            is_away = True
        finally:
            connections.close_all()
        threading.Event().wait(LOOK_EVERY)
