"""Slow requests leave threads for pages and ``/healthz``, whatever keeps them."""

from __future__ import annotations

import json
import select
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial

import pytest
from django.db import connection, transaction
from django.http import HttpResponse, StreamingHttpResponse
from django.test import Client, RequestFactory

from annotations.models import ApiToken, World
from gpsr_site.web import thread_shares
from gpsr_site.web.thread_shares import SHARES, THREADS, SlowKind, ThreadShares, kind_of
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.policy import POLICY
from tests.waiting import PATIENCE_SECONDS, wait_for

PARSE = "/api/v1/worlds/home/parse/"
UTTERANCES = "/api/v1/worlds/home/utterances/"
DOWNLOAD = "/w/home/download/"


def request_of(kind: SlowKind):
    if kind is SlowKind.LONG:
        return RequestFactory().get(DOWNLOAD)
    path, sent = {
        SlowKind.WRITE: (UTTERANCES, "application/json"),
        SlowKind.BATCH: (PARSE, "application/jsonl; charset=utf-8"),
    }[kind]
    return RequestFactory().post(path, "{}", sent)


def set_share(monkeypatch, kind: SlowKind, **changes) -> None:
    monkeypatch.setitem(thread_shares.SHARES, kind, replace(SHARES[kind], **changes))


def test_all_slow_requests_together_leave_threads_for_others():
    assert sum(share.threads for share in SHARES.values()) <= THREADS - 3


@pytest.mark.parametrize("kind", SlowKind)
def test_who_finds_no_thread_is_told_when_to_come_back(kind, monkeypatch):
    set_share(monkeypatch, kind, threads=2, at_work=2)
    answers = []

    def view(request):  # each request asks for another one, until one is refused
        answers.append(shares(request_of(kind)))
        return HttpResponse("ok")

    shares = ThreadShares(view)
    assert shares(request_of(kind)).status_code == 200
    assert [answer.status_code for answer in answers] == [503, 200]
    assert answers[0]["Retry-After"] == str(SHARES[kind].retry_after)
    if kind is not SlowKind.LONG:
        assert answers[0]["Content-Type"] == "application/problem+json"


def test_a_writer_waits_for_its_turn_and_not_for_ever(monkeypatch):
    set_share(monkeypatch, SlowKind.WRITE, at_work=1, patience=0.1)
    answers = []

    def view(request):
        answers.append(shares(request_of(SlowKind.WRITE)).status_code)
        assert shares(request_of(SlowKind.BATCH)).status_code == 200
        return HttpResponse("ok")

    shares = ThreadShares(
        lambda request: HttpResponse("ok") if "parse" in request.path else view(request)
    )
    assert shares(request_of(SlowKind.WRITE)).status_code == 200
    assert answers == [503]


def test_an_answer_in_pieces_has_its_thread_until_it_is_closed(monkeypatch):
    set_share(monkeypatch, SlowKind.LONG, threads=1, at_work=1)
    shares = ThreadShares(lambda request: StreamingHttpResponse(iter([b"1", b"2"])))
    first = shares(request_of(SlowKind.LONG))
    assert next(iter(first)) == b"1"
    assert shares(request_of(SlowKind.LONG)).status_code == 503
    first.close()
    assert shares(request_of(SlowKind.LONG)).status_code == 200


def test_what_writes_is_a_writer(sample, subtests):
    for name in {rule.name for rule in POLICY if rule.method == "post"} - {"admin:index"}:
        with subtests.test(name):
            kind = kind_of("POST", address(name, sample).partition("?")[0])
            assert kind in (SlowKind.WRITE, None)
            if not name.startswith("api:"):
                assert kind is (None if name == "campaign_check" else SlowKind.WRITE)


def test_the_address_says_what_a_request_asks_of_its_thread():
    for path in ("/healthz", "/w/home/", "/nowhere"):
        assert kind_of("GET", path) is kind_of("HEAD", path) is None
    assert kind_of("GET", DOWNLOAD) is SlowKind.LONG
    assert kind_of("POST", "/login/") is kind_of("DELETE", "/nowhere") is SlowKind.WRITE
    assert kind_of("POST", PARSE, "application/json") is None
    for spelling in ("application/jsonl", "Application/JSONL", "*/jsonl; charset=utf-8"):
        assert kind_of("POST", PARSE, spelling) is SlowKind.BATCH
    assert kind_of("POST", UTTERANCES, "application/jsonl") is SlowKind.WRITE


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


@pytest.fixture
def few_writers(monkeypatch):
    """Before ``site``, which reads it."""
    set_share(monkeypatch, SlowKind.WRITE, at_work=2, patience=1)


def test_pages_go_on_while_writers_wait(few_writers, site, sample, annotator):
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
        expected = len(saving) - 2
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
