"""The web server survives clients that send slowly, send too much, or do not read."""

from __future__ import annotations

import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

import pytest

from annotations.web.rest.streaming import BrokenOff
from gpsr_site.processes import web_server_commands
from gpsr_site.web.body_limits import ORDINARY_BYTES
from gpsr_site.web.server import listen, require_free_port
from gpsr_site.web.thread_shares import THREADS
from tests.waiting import PATIENCE_SECONDS, wait_for

GIGABYTE = 1 << 30
SERVE_WHAT_HANGS = """
import sys, time
import django
django.setup()
from gpsr_site.web.server import serve
def hang(environ, start_response):
    print("at work", flush=True)
    time.sleep(600)
serve(hang, "127.0.0.1", int(sys.argv[1]))
"""


def head(path: str, *headers: str) -> bytes:
    lines = [f"POST {path} HTTP/1.1", "Host: localhost", *headers, "", ""]
    return "\r\n".join(lines).encode()


def ask(port: int) -> bool:
    """Send a request whose answer nobody reads; return whether the server listens."""
    try:
        connection = socket.create_connection(("127.0.0.1", port))
    except ConnectionRefusedError:
        return False
    connection.sendall(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
    return True


def test_half_sent_requests_and_slow_bodies_hold_up_nobody(site):
    half = [site.connect(b"GET / HTTP/1.1\r\nHost: localh") for _ in range(2 * THREADS)]
    slow = [
        site.connect(head("/login/", "Content-Length: 60000") + b"username=")
        for _ in range(2 * THREADS)
    ]
    assert site.status("/healthz") == 200
    assert site.status("/login/") == 200
    for connection in half + slow:
        connection.close()


def test_who_does_not_read_holds_no_thread(server):
    is_made = threading.Event()

    def large(environ, start_response):
        start_response("200 OK", [("Content-Type", "text/plain")])
        for _ in range(40):
            yield b"a" * ORDINARY_BYTES
        is_made.set()

    server.application = large
    with server.connect(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n"):
        assert is_made.wait(PATIENCE_SECONDS)


def test_an_answer_that_ends_early_is_not_taken_for_whole(server):
    def broken(environ, start_response):
        start_response("200 OK", [("Content-Type", "text/plain")])
        yield b"half"
        raise BrokenOff("it took too long")

    server.application = broken
    answer = server.answer_to(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
    assert answer.startswith(b"HTTP/1.1 200 ")
    assert answer.endswith(b"4\r\nhalf\r\n")  # the last chunk, of no bytes, is missing


@pytest.mark.parametrize("path", ["/login/", "/w/home/import/", "/nowhere"])
def test_an_anonymous_gigabyte_is_refused_at_once_and_leaves_no_file(
    path, site, tmp_path, monkeypatch
):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    multipart = "Content-Type: multipart/form-data; boundary=x"
    answer = site.answer_to(head(path, multipart, f"Content-Length: {GIGABYTE}") + b"--x\r\n")
    assert answer.startswith(b"HTTP/1.1 413 ")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("path", ["/login/", "/api/v1/worlds/home/import/"])
def test_a_browser_that_sends_too_much_reads_why(site, path):
    length = 20 * ORDINARY_BYTES
    whole = head(path, f"Content-Length: {length}", "Connection: close") + b"a" * length
    answer = site.answer_to(whole)
    assert answer.startswith(b"HTTP/1.1 413 ") and b" 64 kB" in answer
    assert (b"Content-Type: application/problem+json" in answer) == path.startswith("/api/")


@pytest.mark.processes
def test_a_stop_does_not_wait_for_a_request_that_hangs():
    (listening,) = listen("127.0.0.1", 0)
    port = listening.getsockname()[1]
    listening.close()
    process = subprocess.Popen(
        [sys.executable, "-c", SERVE_WHAT_HANGS, str(port)], stdout=subprocess.PIPE, text=True
    )
    try:
        wait_for(lambda: ask(port), "it listens")
        assert process.stdout.readline() == "at work\n"
        began = time.monotonic()
        process.send_signal(signal.SIGTERM)
        assert process.wait(PATIENCE_SECONDS) == 0
        assert time.monotonic() - began < 5
    finally:
        process.kill()


def test_servers_share_a_port_if_both_do_and_nothing_else_takes_it():
    servers = listen("127.0.0.1", 0, shares_port=True)
    port = servers[0].getsockname()[1]
    try:
        servers += listen("127.0.0.1", port, shares_port=True)
        with pytest.raises(OSError):
            listen("127.0.0.1", port)
        with pytest.raises(OSError):
            require_free_port("127.0.0.1", port)
    finally:
        for each in servers:
            each.close()
    require_free_port("127.0.0.1", port)


def test_several_web_servers_are_as_many_commands():
    (alone,) = web_server_commands(1).values()
    both = web_server_commands(2)
    assert list(both) == ["web server 1", "web server 2"]
    assert all(command == [*alone, "--share-port"] for command in both.values())
