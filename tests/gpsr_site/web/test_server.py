"""The web server survives clients that send slowly, send too much, or do not read."""

from __future__ import annotations

import tempfile
from urllib.parse import urlencode

import pytest
from django.test import Client

from gpsr_site.processes import web_server_commands
from gpsr_site.web import server
from gpsr_site.web.body_limits import ANONYMOUS_BYTES, ORDINARY_BYTES, largest_body
from gpsr_site.web.server import WebServer, require_free_port
from gpsr_site.wsgi import application
from tests.waiting import wait_for

GIGABYTE = 1 << 30


def head(path: str, *headers: str) -> bytes:
    lines = [f"POST {path} HTTP/1.1", "Host: localhost", *headers, "", ""]
    return "\r\n".join(lines).encode()


def test_half_sent_requests_and_slow_bodies_hold_up_nobody(site):
    half = [site.connect(b"GET / HTTP/1.1\r\nHost: localh") for _ in range(2 * server.THREADS)]
    slow = [
        site.connect(head("/login/", "Content-Length: 60000") + b"username=")
        for _ in range(2 * server.THREADS)
    ]
    assert site.status("/healthz") == 200
    assert site.status("/login/") == 200
    for connection in half + slow:
        connection.close()


@pytest.mark.parametrize("path", ["/login/", "/admin/login/", "/w/home/import/", "/nowhere"])
def test_an_anonymous_gigabyte_is_refused_at_once_and_leaves_no_file(
    path, site, tmp_path, monkeypatch
):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    multipart = "Content-Type: multipart/form-data; boundary=x"
    answer = site.answer_to(head(path, multipart, f"Content-Length: {GIGABYTE}") + b"--x\r\n")
    assert answer.startswith(b"HTTP/1.1 413 ")
    assert list(tmp_path.iterdir()) == []


def test_a_body_in_chunks_is_refused_as_soon_as_it_is_too_large(site):
    chunk = b"10000\r\n" + b"a" * 0x10000 + b"\r\n"
    answer = site.answer_to(head("/login/", "Transfer-Encoding: chunked") + chunk + chunk)
    assert answer.startswith(b"HTTP/1.1 413 ")


def test_a_browser_that_sends_too_much_reads_why(site):
    length = 20 * ORDINARY_BYTES
    answer = site.answer_to(head("/login/", f"Content-Length: {length}") + b"a" * length)
    assert answer.startswith(b"HTTP/1.1 413 ") and b" 64 kB" in answer


def test_a_cookie_does_not_make_a_large_body_welcome(site):
    cookie, length = "Cookie: sessionid=made-up", ORDINARY_BYTES
    answer = site.answer_to(
        head("/login/", cookie, f"Content-Length: {length}", "Connection: close") + b"a" * length
    )
    assert answer.startswith(b"HTTP/1.1 413 ")
    assert b" 64 kB" in answer


def test_only_the_import_takes_files(settings):
    large = settings.UPLOAD_MAX_BYTES
    assert largest_body("/w/home/import/", True) > large
    assert largest_body("/w/home/import/pairs/", True) > large
    assert largest_body("/w/home/import/", False) == ANONYMOUS_BYTES
    assert largest_body("/w/home/templates/new/", True) == ORDINARY_BYTES


def test_a_request_that_never_arrives_whole_is_ended(site, monkeypatch):
    monkeypatch.setattr(server, "ARRIVAL_SECONDS", 1)
    connection = site.connect(b"GET / HTTP/1.1\r\nX-Slow: ")

    def is_ended():
        try:
            connection.sendall(b"y")
        except OSError:
            return True
        return False

    wait_for(is_ended, "the connection is closed")


def test_a_request_that_arrives_in_pieces_is_answered(site):
    connection = site.connect(b"GET /healthz HTTP/1.1\r\nHost: loc")
    assert site.status("/healthz") == 200  # the server has read the first piece
    connection.sendall(b"alhost\r\nConnection: close\r\n\r\n")
    assert connection.recv(1000).startswith(b"HTTP/1.1 200 ")


def test_eight_templates_that_explode_do_not_stop_the_site(site, sample, annotator):
    client = Client()
    client.force_login(annotator)
    category = sample.world.grammar.task_categories.get()
    typed = {"pattern": "(a|b) " * 60 + "$vbfind", "form": "(go $vbfind)"}
    body = urlencode({**typed, "task_category": category.pk})
    token = "a" * 32
    cookies = f"sessionid={client.cookies['sessionid'].value}; csrftoken={token}"
    asked = [
        site.connect(
            head(
                "/w/home/templates/check/",
                f"Cookie: {cookies}",
                f"X-CSRFToken: {token}",
                "Content-Type: application/x-www-form-urlencoded",
                f"Content-Length: {len(body)}",
                "Connection: close",
            )
            + body.encode()
        )
        for _ in range(server.THREADS)
    ]
    assert site.status("/healthz") == 200
    for connection in asked:
        assert connection.recv(1000).startswith(b"HTTP/1.1 200 ")
        connection.close()


def test_servers_share_a_port_if_both_do_and_nothing_else_takes_it(transactional_db):
    servers = [WebServer(application, "127.0.0.1", 0, shares_port=True)]
    port = servers[0].port
    try:
        servers.append(WebServer(application, "127.0.0.1", port, shares_port=True))
        assert servers[1].port == port
        with pytest.raises(OSError):
            WebServer(application, "127.0.0.1", port)
        with pytest.raises(OSError):
            require_free_port("127.0.0.1", port)
    finally:
        for each in servers:
            each.stop()
    require_free_port("127.0.0.1", port)


def test_several_web_servers_are_as_many_commands():
    (alone,) = web_server_commands(1).values()
    both = web_server_commands(2)
    assert list(both) == ["web server 1", "web server 2"]
    assert all(command == [*alone, "--share-port"] for command in both.values())
