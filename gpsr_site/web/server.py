"""The web server: waitress by its documented arguments. It reads a request whole before a thread sees it, and
keeps what a client is slow to read, so that slow clients cost a connection and no thread."""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
from typing import Any

import waitress
from django.conf import settings

from gpsr_site.web.body_limits import ORDINARY_BYTES
from gpsr_site.web.thread_shares import THREADS

# Within the 5 s that a stop may take (docs/design/architecture.md, Background work).
STOP_SECONDS = 3
OPTIONS: dict[str, Any] = {
    "threads": THREADS,
    "connection_limit": 1000,
    "channel_timeout": 30,  # seconds without a byte
    "cleanup_interval": 5,
    "asyncore_use_poll": True,
    "max_request_header_size": 32 * 1024,
    # What is not much too large arrives, so that LimitBodies can say why it is refused.
    "max_request_body_size": 3 * settings.UPLOAD_MAX_BYTES,
    "inbuf_overflow": ORDINARY_BYTES + 1,  # bytes; files alone touch the disk
    # What a client has not read yet waits on the disk, and holds no thread.
    "outbuf_high_watermark": 2**30,  # bytes
    "clear_untrusted_proxy_headers": False,  # gpsr_site.web.proxies decides about those
    "ident": "",
}


def listen(host: str, port: int, shares_port: bool = False) -> list[socket.socket]:
    """Return sockets on all addresses of ``host``. Raises OSError where something else listens there.

    Servers that all ``shares_port`` may have the same one: the system gives each connection to one of them.
    """
    addresses = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    return [
        socket.create_server(address[:2], family=family, reuse_port=shares_port)
        for family, *_, address in addresses
    ]


def require_free_port(host: str, port: int) -> None:
    """Raise OSError where something else listens there, a server that shares its port included."""
    for each in listen(host, port):
        each.close()


def serve(application: Any, host: str, port: int, shares_port: bool = False) -> None:
    """Serve until SIGTERM or SIGINT. Raises OSError where it cannot listen."""
    signal.signal(signal.SIGTERM, _stop)
    waitress.serve(application, sockets=listen(host, port, shares_port), **OPTIONS)


def _stop(*_: Any) -> None:
    """Give requests at work ``STOP_SECONDS``; waitress would give them five."""
    timer = threading.Timer(STOP_SECONDS, os._exit, [0])
    timer.daemon = True
    timer.start()
    sys.exit()
