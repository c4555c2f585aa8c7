"""The web server: waitress, which reads whole requests before a thread sees them.

A client that sends or reads slowly, or not at all, costs a connection and no thread. A long answer that is
read slowly keeps a thread, up to a limit. ``shares`` says which requests may have how many threads.
Waitress's own limits are not enough: a request has a total time to arrive, a response must keep being read,
and how large a body may be depends on its address and is judged once the headers are there.

Waitress documents ``serve`` and its arguments alone, and none of them can say this:
``max_request_body_size`` is one number for all addresses, ``channel_timeout`` starts anew with each
byte, and ``threads`` knows no kinds of requests. So its classes are subclassed here and in ``shares``.
"""

from __future__ import annotations

import re
import signal
import socket
import sys
import time
from typing import Any

from django.conf import settings
from waitress import wasyncore
from waitress.adjustments import Adjustments
from waitress.parser import HTTPRequestParser
from waitress.server import TcpWSGIServer
from waitress.utilities import RequestEntityTooLarge

from gpsr_site.web.body_limits import ORDINARY_BYTES, largest_body
from gpsr_site.web.thread_shares import THREADS, Dispatcher, SharingChannel

CONNECTIONS = 1000
IDLE_SECONDS = 30
ARRIVAL_SECONDS = 120
DISCARD_SECONDS = 10
# Within the 5 s that a stop may take (docs/design/architecture.md, Background work).
STOP_SECONDS = 3
# Until the last byte of an answer; a client that reads a large one slower than that is cut off.
ANSWER_SECONDS = 1800


class RequestLimits:
    """The limits of one request, in the place of waitress's adjustments for all of them."""

    def __init__(self, adjustments: Adjustments) -> None:
        self.adjustments = adjustments
        self.max_request_body_size = 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self.adjustments, name)


class RequestParser(HTTPRequestParser):
    """A request whose body may be as large as its address allows."""

    def __init__(self, adjustments: Adjustments) -> None:
        super().__init__(RequestLimits(adjustments))
        self.begun_at = time.time()

    def parse_header(self, header_plus: bytes) -> None:
        super().parse_header(header_plus)
        if self.body_rcv is None:
            return
        session = rf"(?:^|;\s*){re.escape(settings.SESSION_COOKIE_NAME)}="
        has_session = re.search(session, self.headers.get("COOKIE", "")) is not None
        has_key = "AUTHORIZATION" in self.headers or has_session
        # waitress refuses what reaches the limit, the middleware what exceeds it.
        self.adj.max_request_body_size = largest_body(self.path, has_key) + 1

    def received(self, data: bytes) -> int:
        consumed: int = super().received(data)
        if self.is_too_large:
            limit = self.adj.max_request_body_size // 1024
            self.error = RequestEntityTooLarge(f"This address takes no more than {limit:,} kB.")
        return consumed

    @property
    def is_too_large(self) -> bool:
        """Whether the request brings more than its address allows."""
        return isinstance(self.error, RequestEntityTooLarge)


class WatchedChannel(SharingChannel):
    """A connection that is closed when its request does not arrive, or its answer is not read.

    A client that is refused in the middle of its body reads the answer only after it has sent
    the rest, so that is taken and thrown away for a few seconds.
    """

    parser_class = RequestParser
    discards_until = 0.0
    answered_since = 0.0
    close_when_flushed: bool

    def service(self) -> None:
        self.answered_since = time.time()
        super().service()

    def is_stuck(self, now: float) -> bool:
        """Return whether the client takes too long to send its request or to read its answer; ``now`` is in
        seconds since the epoch."""
        if self.discards_until:
            return self.discards_until < now
        if self.total_outbufs_len:
            is_slow = bool(self.answered_since) and self.answered_since < now - ANSWER_SECONDS
            return is_slow or self.last_activity < now - IDLE_SECONDS
        return self.request is not None and self.request.begun_at < now - ARRIVAL_SECONDS

    def received(self, data: bytes) -> bool:
        is_open: bool = super().received(data)
        if any(request.is_too_large for request in self.requests):
            self.discards_until = time.time() + DISCARD_SECONDS
        return is_open

    def readable(self) -> bool:
        return bool(self.discards_until) or super().readable()

    def handle_read(self) -> None:
        if self.discards_until:
            try:
                self.recv(self.adj.recv_bytes)  # closes the channel at the end
            except OSError:
                self.handle_close()
        else:
            super().handle_read()

    def handle_write(self) -> None:
        if not self.discards_until or self.will_close:
            super().handle_write()
            return
        # Private: waitress has no public method that sends what waits and then keeps the channel open.
        self._flush_exception(self._flush_some_if_lockable)
        if self.close_when_flushed and not self.total_outbufs_len:
            self.close_when_flushed = False
            self.socket.shutdown(socket.SHUT_WR)


class ListeningServer(TcpWSGIServer):
    """A listening socket; waitress asks for its maintenance every ``cleanup_interval``."""

    channel_class = WatchedChannel

    def set_reuse_addr(self) -> None:
        super().set_reuse_addr()
        if self.adj.shares_port:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)

    def maintenance(self, now: float) -> None:
        super().maintenance(now)
        for channel in list(self.active_channels.values()):
            if channel.is_stuck(now):
                channel.will_close = True


class WebServer:
    """Listens on all addresses of ``host``; ``port`` 0 takes a free one.

    Servers that all ``shares_port`` may have the same one: the system gives each connection to one of them.
    """

    def __init__(self, application: Any, host: str, port: int, shares_port: bool = False) -> None:
        adjustments = Adjustments(
            host=f"[{host}]" if ":" in host else host,
            port=port,
            threads=THREADS,
            connection_limit=CONNECTIONS,
            channel_timeout=IDLE_SECONDS,
            cleanup_interval=5,
            inbuf_overflow=ORDINARY_BYTES + 1,  # only files of people who may import touch the disk
            max_request_header_size=32 * 1024,
            clear_untrusted_proxy_headers=False,  # gpsr_site.web.proxies decides about those
            ident="",
        )
        adjustments.shares_port = shares_port
        self._dispatcher = Dispatcher()
        self._dispatcher.set_thread_count(adjustments.threads)
        self._sockets: dict[int, Any] = {}
        listening = [
            ListeningServer(
                application,
                self._sockets,
                dispatcher=self._dispatcher,
                adj=adjustments,
                sockinfo=address,
            )
            for address in adjustments.listen
        ]
        self.port = int(listening[0].effective_port)

    def run(self) -> None:
        """Serve until SystemExit or KeyboardInterrupt, or until ``stop`` is called elsewhere."""
        try:
            wasyncore.loop(timeout=1, map=self._sockets, use_poll=True)
        except (SystemExit, KeyboardInterrupt):
            self.stop()

    def stop(self) -> None:
        """Give requests at work ``STOP_SECONDS``, then close every connection."""
        self._dispatcher.shutdown(timeout=STOP_SECONDS)
        wasyncore.close_all(self._sockets)


def require_free_port(host: str, port: int) -> None:
    """Raise OSError where something else listens there, a server that shares its port included."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        probe.bind((host, port))


def serve(application: Any, host: str, port: int, shares_port: bool = False) -> None:
    """Serve until SIGTERM or SIGINT."""
    server = WebServer(application, host, port, shares_port)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    server.run()
