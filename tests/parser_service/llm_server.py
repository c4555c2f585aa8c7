"""A small server of OpenAI's chat protocol, with the faults that real ones have.

Its model repeats the answer of the last example that it was shown, which is the nearest.
"""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from parser_service.parsers import server_address
from parser_service.parsers.server_address import ModelServer, Patience

MODEL = "tiny"
REPORTED = "tiny-2026-07"
KEY = "sk-a-key-that-nobody-may-see"
# As patient as a server, in a hundredth of the time.
QUICK = Patience(connecting=30, answer=30, tries=3, first_pause=0.01, longest_pause=2)

Fault = Callable[["Handler"], None]
"""Answers a request, or breaks it off."""


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server: TinyServer
    body: dict[str, Any]  # of the question

    def do_GET(self) -> None:
        self.server.headers.append(dict(self.headers))
        if self.server.models is None:
            self.send_json({"error": {"message": "not found"}}, 404)
        else:
            self.send_json(
                {"object": "list", "data": [{"id": each} for each in self.server.models]}
            )

    def do_POST(self) -> None:
        self.body = body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        server = self.server
        with server.lock:
            server.headers.append(dict(self.headers))
            server.asked.append({"path": self.path, **body})
            fault = server.faults.pop(0) if server.faults else server.always
        if fault is not None:
            return fault(self)
        # Over before it is sent: who has an answer may ask again before this thread goes on.
        with server.counted():
            time.sleep(server.seconds)
            answer = server.think(body)
        self.send_answer(answer)

    def send_answer(self, text: str | None, **choice: Any) -> None:
        message = {"role": "assistant", "content": text, **choice.pop("message", {})}
        self.send_json(
            {
                "object": "chat.completion",
                "model": self.server.reports,
                "choices": [{"index": 0, "finish_reason": "stop", **choice, "message": message}],
            }
        )

    def send_json(self, value: Any, status: int = 200, **headers: str) -> None:
        self.send_bytes(json.dumps(value).encode(), status, **headers)

    def send_bytes(self, body: bytes, status: int = 200, **headers: str) -> None:
        self.send_response(status)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Content-Type", "application/json")
        for name, value in headers.items():
            self.send_header(name.replace("_", "-"), value)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: Any) -> None:
        pass


class TinyServer(ThreadingHTTPServer):
    """``faults`` answer the next questions, one each; ``always`` all that come after them."""

    daemon_threads = True
    allow_reuse_address = True
    request_queue_size = 64

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        self.lock = threading.Lock()
        self.asked: list[dict[str, Any]] = []
        self.headers: list[dict[str, str]] = []
        self.faults: list[Fault] = []
        self.always: Fault | None = None
        self.models: list[str] | None = [MODEL]
        self.reports: Any = REPORTED
        self.seconds = 0.0
        self.think: Callable[[dict[str, Any]], str] = repeat_the_last_example
        self.now = self.most_at_once = 0

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.server_address[1]}/v1"

    @contextmanager
    def counted(self) -> Iterator[None]:
        """Count among those that are thought about at once."""
        with self.lock:
            self.now += 1
            self.most_at_once = max(self.most_at_once, self.now)
        yield
        with self.lock:
            self.now -= 1

    def handle_error(self, *_: Any) -> None:
        """Whoever asks may hang up at any time."""


def repeat_the_last_example(body: dict[str, Any]) -> str:
    return [each["content"] for each in body["messages"] if each["role"] == "assistant"][-1]


@contextmanager
def tiny_server() -> Iterator[TinyServer]:
    with TinyServer() as server:
        threading.Thread(target=server.serve_forever, args=[0.02], daemon=True).start()
        try:
            yield server
        finally:
            server.shutdown()


@contextmanager
def installed(server: ModelServer) -> Iterator[None]:
    """Let ``server`` be the one of this installation."""
    before = server_address.server()
    server_address.use_server(server)
    try:
        yield
    finally:
        server_address.use_server(before)


@contextmanager
def installed_tiny_server(folder: Path) -> Iterator[TinyServer]:
    """Let a server that is made here be the one of this installation; answers are kept in ``folder``."""
    with (
        tiny_server() as server,
        installed(ModelServer(server.url, KEY, patience=QUICK, answers=folder / "llm")),
    ):
        yield server


def fails(status: int, message: str = "", **headers: str) -> Fault:
    """Answer with a status and a sentence, as the protocol has them."""
    return lambda handler: handler.send_json({"error": {"message": message}}, status, **headers)


def says(text: str | None, **choice: Any) -> Fault:
    """Let the model write this."""
    return lambda handler: handler.send_answer(text, **choice)


def sends(body: bytes, status: int = 200, **headers: str) -> Fault:
    """Send these bytes."""
    return lambda handler: handler.send_bytes(body, status, **headers)


def hangs_up(handler: Handler) -> None:
    """Break off without a word."""
    handler.close_connection = True
    handler.connection.close()


def cuts_the_body(handler: Handler) -> None:
    """Announce more than is sent."""
    handler.send_response(200)
    handler.send_header("Content-Length", "1000")
    handler.end_headers()
    handler.wfile.write(b'{"choices": [')
    handler.wfile.flush()
    hangs_up(handler)


def drips(handler: Handler) -> None:
    """Send a byte now and then, and never an answer."""
    handler.send_response(200)
    handler.send_header("Content-Length", "100000")
    handler.end_headers()
    for _ in range(600):
        handler.wfile.write(b" ")
        handler.wfile.flush()
        time.sleep(0.05)
