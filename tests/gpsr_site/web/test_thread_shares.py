"""Slow requests leave threads for pages and the last one for ``/healthz``, whatever keeps them."""

from __future__ import annotations

import json
import select
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import pytest
from django.db import connection, transaction
from django.test import Client

from annotations.models import ApiToken, World
from annotations.web.rest.streaming import BrokenOff
from gpsr_site.web import thread_shares
from gpsr_site.web.server import WebServer
from gpsr_site.web.thread_shares import (
    ALL_BUT_HEALTH,
    FOR_READING,
    REFUSED,
    SHARES,
    SLOW,
    THREADS,
    RequestKind,
    ThreadShare,
    kind_of,
)
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.policy import POLICY
from tests.gpsr_site.web.conftest import Site
from tests.waiting import PATIENCE_SECONDS, wait_for

PARSE = "/api/v1/worlds/home/parse/"
UTTERANCES = "/api/v1/worlds/home/utterances/"
DOWNLOAD = "/w/home/download/"
SECOND = 1.0


class Holding:
    """An application whose requests, all but those to ``/healthz``, wait until they are let go."""

    def __init__(self) -> None:
        self.at_work: list[str] = []
        self.refused: list[str] = []
        self.let_go = threading.Event()

    def __call__(self, environ, start_response):
        what = f"{environ['REQUEST_METHOD']} {environ['PATH_INFO']}"
        if REFUSED in environ:
            self.refused.append(what)
        elif environ["PATH_INFO"] != "/healthz":
            self.at_work.append(what)
            self.let_go.wait(PATIENCE_SECONDS)
        start_response("200 OK", [("Content-Length", "2")])
        return [b"ok"]


@contextmanager
def serving(application) -> Iterator[Site]:
    server = WebServer(application, "127.0.0.1", 0)
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    try:
        yield Site(server.port)
    finally:
        server.stop()
        thread.join(10)


@pytest.fixture
def holding():
    application = Holding()
    with serving(application) as site:
        application.site = site
        yield application
        application.let_go.set()


def send(holding: Holding, count: int, method: str, path: str, kind: str = "") -> None:
    lines = [f"{method} {path} HTTP/1.1", "Host: localhost", "Content-Length: 0"]
    lines += [f"Content-Type: {kind}"] if kind else []
    for _ in range(count):
        holding.site.connect("\r\n".join([*lines, "", ""]).encode())


def test_writers_leave_threads_for_pages_and_pages_leave_one_for_the_health(holding):
    send(holding, 20, "POST", UTTERANCES)
    wait_for(lambda: len(holding.at_work) == SLOW, "writers have their share")
    send(holding, 20, "GET", "/w/home/")
    wait_for(lambda: len(holding.at_work) == ALL_BUT_HEALTH, "pages have theirs")
    time.sleep(0.2)
    assert holding.at_work.count("GET /w/home/") == FOR_READING
    assert holding.site.status("/healthz") == 200
    holding.let_go.set()
    wait_for(lambda: len(holding.at_work) == 40, "all have their turn")
    assert holding.refused == []


@pytest.mark.parametrize("kind", [RequestKind.LONG, RequestKind.BATCH])
def test_batches_and_downloads_have_a_small_share(holding, kind):
    if kind is RequestKind.LONG:
        send(holding, THREADS, "GET", DOWNLOAD)
    else:
        send(holding, THREADS, "POST", PARSE, "application/jsonl")
    wait_for(lambda: len(holding.at_work) == SHARES[kind].threads, "some are at work")
    send(holding, 1, "POST", UTTERANCES)
    wait_for(lambda: f"POST {UTTERANCES}" in holding.at_work, "others go on")
    assert len(holding.at_work) == SHARES[kind].threads + 1


def test_a_batch_that_finds_no_thread_is_refused_at_once(holding):
    send(holding, 10, "POST", PARSE, "application/jsonl; charset=utf-8")
    wait_for(
        lambda: len(holding.refused) == 10 - SHARES[RequestKind.BATCH].threads,
        "the rest is refused",
    )


def test_one_utterance_waits_for_no_writer(holding):
    send(holding, 20, "POST", UTTERANCES)
    wait_for(lambda: len(holding.at_work) == SLOW, "writers have their share")
    send(holding, 1, "POST", PARSE, "application/json")
    wait_for(lambda: f"POST {PARSE}" in holding.at_work, "the robot has an answer")


def test_who_has_waited_too_long_is_refused_while_others_still_work(holding, monkeypatch):
    monkeypatch.setitem(thread_shares.SHARES, RequestKind.WRITE, ThreadShare(SLOW, patience=0.2))
    send(holding, SLOW + 3, "POST", UTTERANCES)
    wait_for(lambda: len(holding.refused) == 3, "those who find no thread are refused")
    assert len(holding.at_work) == SLOW


@pytest.mark.parametrize("rule", [rule for rule in POLICY if rule.method == "post"], ids=str)
def test_what_writes_is_a_writer(rule, sample):
    if rule.name == "admin:index":
        return
    kind = kind_of("POST", address(rule.name, sample).partition("?")[0])
    assert kind in (RequestKind.WRITE, RequestKind.READ)
    if not rule.name.startswith("api:"):
        only_reads = rule.name == "campaign_check"
        assert kind is (RequestKind.READ if only_reads else RequestKind.WRITE)


def test_the_address_says_what_a_request_asks_of_its_thread():
    assert kind_of("GET", "/healthz") is RequestKind.HEALTH
    assert kind_of("GET", "/w/home/") is kind_of("HEAD", "/nowhere") is RequestKind.READ
    assert kind_of("GET", DOWNLOAD) is RequestKind.LONG
    assert kind_of("POST", "/login/") is kind_of("DELETE", "/nowhere") is RequestKind.WRITE
    assert kind_of("POST", PARSE, "application/json") is RequestKind.READ
    for spelling in ("application/jsonl", "Application/JSONL", "*/jsonl; charset=utf-8"):
        assert kind_of("POST", PARSE, spelling) is RequestKind.BATCH
    assert kind_of("POST", UTTERANCES, "application/jsonl") is RequestKind.WRITE


def test_an_answer_that_ends_early_is_not_taken_for_whole():
    def broken(environ, start_response):
        start_response("200 OK", [("Content-Type", "text/plain")])
        yield b"half"
        raise BrokenOff("it took too long") if environ["PATH_INFO"] == "/late" else OSError("gone")

    with serving(broken) as site:
        for path in ("/late", "/gone"):
            answer = site.answer_to(f"GET {path} HTTP/1.1\r\nHost: x\r\n\r\n".encode())
            assert answer.startswith(b"HTTP/1.1 200 ")
            assert answer.endswith(b"4\r\nhalf\r\n")  # the last chunk, of no bytes, is missing


@contextmanager
def locked(world: World) -> Iterator[None]:
    """Somebody else writes for a while: the whole of SQLite, or the row of the world."""
    is_locked, let_go = threading.Event(), threading.Event()

    def write() -> None:
        with transaction.atomic():
            World.objects.hold().get(pk=world.pk)
            is_locked.set()
            let_go.wait(PATIENCE_SECONDS)
        connection.close()

    thread = threading.Thread(target=write, daemon=True)
    thread.start()
    assert is_locked.wait(PATIENCE_SECONDS)
    try:
        yield
    finally:
        let_go.set()
        thread.join()


def test_pages_go_on_while_writers_wait(site, sample, annotator, monkeypatch):
    monkeypatch.setitem(thread_shares.SHARES, RequestKind.WRITE, ThreadShare(SLOW, patience=1))
    key = ApiToken.issue(annotator, "robot", scope="annotate")[1]
    browser = Client()
    browser.force_login(annotator)
    cookie = f"Cookie: sessionid={browser.cookies['sessionid'].value}"

    def page(path: str) -> bytes:
        lines = [f"GET {path} HTTP/1.1", "Host: localhost", cookie, "Connection: close", "", ""]
        return site.answer_to("\r\n".join(lines).encode())

    assert page("/w/home/").startswith(b"HTTP/1.1 200 ")
    with locked(sample.world):
        saving = [site.connect(saved(f"go home {number}", key)) for number in range(THREADS + 4)]
        for path in ("/healthz", "/w/home/", "/w/home/utterances/", "/healthz"):
            began = time.monotonic()
            assert page(path).startswith(b"HTTP/1.1 200 ")
            assert time.monotonic() - began < PATIENCE_SECONDS / 2
        expected = len(saving) - SLOW
        wait_for(lambda: len(answered(saving)) == expected, "those beyond the share are refused")
        refused = answered(saving)
        answers = [b"".join(iter(partial(each.recv, 10_000), b"")) for each in refused]
    for answer in answers:
        assert answer.startswith(b"HTTP/1.1 503 ") and b"Retry-After: 5" in answer
        assert b"Content-Type: application/problem+json" in answer and b'"status": 503' in answer
    for connection_of in set(saving) - set(refused):
        assert connection_of.recv(1000).startswith(b"HTTP/1.1 201 ")


def answered(connections: list[socket.socket]) -> list[socket.socket]:
    """Return those from which something can be read."""
    return select.select(connections, [], [], 0)[0]


def saved(text: str, key: str) -> bytes:
    body = json.dumps({"texts": [text]}).encode()
    lines = [
        f"POST {UTTERANCES} HTTP/1.1",
        "Host: localhost",
        f"Authorization: Bearer {key}",
        "Content-Type: application/json",
        f"Content-Length: {len(body)}",
        "Connection: close",
    ]
    return "\r\n".join([*lines, "", ""]).encode() + body
