"""The parse server as a process, asked over REST."""

from __future__ import annotations

import fcntl
import json
import os
import resource
import signal
import socket
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from http.client import HTTPConnection
from pathlib import Path

import pytest
from waitress.server import create_server

from annotations.models import ApiToken
from annotations.web.rest.streaming import BrokenOff
from parser_service.runs.promoting import promote
from parser_service.serving import parser_client
from parser_service.serving.parser_client import AWAY, ParserAway, ParserClient, client
from tests.parser_service.served import make_home, trained_run
from tests.parser_service.worker_process import database_url
from tests.waiting import PATIENCE_SECONDS, wait_for

ROOT = Path(__file__).resolve().parents[3]
PARSE = "/api/v1/worlds/home/parse/"


@pytest.fixture
def call(client, annotator):
    """Returns a function that posts to the REST route as the annotator."""
    _, key = ApiToken.issue(annotator, "robot", scope="read")

    def send(data, path=PARSE, content_type="application/json"):
        headers = {"authorization": f"Bearer {key}"}
        return client.post(path, data, content_type=content_type, headers=headers)

    return send


@pytest.fixture
def server(transactional_db, settings, tmp_path):
    """Starts a parse server on the database of the test, and points the site to it."""
    with socket.socket() as chosen:
        chosen.bind(("127.0.0.1", 0))
        port = chosen.getsockname()[1]
    environment = {
        **os.environ,
        "DATABASE_URL": database_url(),
        "PARSER_PORT": str(port),
        "PARSER_SECRET": settings.PARSER_SECRET,
    }
    with (tmp_path / "log").open("wb") as log:
        process = subprocess.Popen(
            [sys.executable, "manage.py", "parse_server"],
            cwd=ROOT,
            env=environment,
            stdout=log,
            stderr=subprocess.STDOUT,
        )
    settings.PARSER_URL = f"http://127.0.0.1:{port}"
    yield process
    process.kill()
    process.wait()
    print((tmp_path / "log").read_text())


def test_rest_says_that_nobody_answers(world, call):
    answer = call({"utterance": "bring me tea"})
    assert answer.status_code == 503
    assert answer.json()["detail"] == AWAY
    assert answer["Retry-After"] == "2"


def test_a_server_that_accepts_and_never_answers_is_away():
    with socket.socket() as mute:
        mute.bind(("127.0.0.1", 0))
        mute.listen()
        asked = ParserClient(f"http://127.0.0.1:{mute.getsockname()[1]}", "secret")
        with pytest.raises(ParserAway):
            asked.parse("home", "bring me tea")


def test_a_server_whose_threads_are_all_busy_is_waited_for(monkeypatch):
    """Its listening thread answers that it is there, long before a thread is free."""
    monkeypatch.setattr(parser_client, "SILENT_SECONDS", 0.1)
    free = threading.Event()

    def application(environ, start_response):
        free.wait(PATIENCE_SECONDS)
        start_response("200 OK", [("Content-Type", "application/json")])
        return [b"[]"]

    server = create_server(application, host="127.0.0.1", port=0, threads=1)
    threading.Thread(target=server.run, daemon=True).start()
    asked = ParserClient(f"http://127.0.0.1:{server.effective_port}", "secret")
    timer = threading.Timer(2 * parser_client.LOOK_AFTER, free.set)
    with ThreadPoolExecutor() as pool:
        answers = [pool.submit(asked.parsers) for _ in range(3)]
        timer.start()
        assert [answer.result() for answer in answers] == [[], [], []]
    server.close()


@pytest.mark.processes
def test_rest_asks_the_server_which_follows_promotions(server, world, call, settings):
    split = make_home(world)
    first, second = trained_run(split), trained_run(split, seed=1)
    wait_for(lambda: client().is_alive(), "the server answers")
    assert call({"utterance": "find the bowl"}).status_code == 409
    promote(first, None)
    wait_for(lambda: call({"utterance": "find the bowl"}).status_code == 200, "it is loaded")
    assert call({"utterance": "find the bowl"}).json()["run"] == first.pk
    promote(second, None)
    wait_for(lambda: call({"utterance": "find the bowl"}).json()["run"] == second.pk, "it changes")
    assert call({"utterance": "find the bowl", "run": first.pk}).json()["run"] == first.pk

    lines = b'{"utterance": "find the bowl"}\n{"utterance": "find the red cup"}\n'
    batch = call(lines, f"{PARSE}?beam=1", "application/jsonl")
    said = [json.loads(line)["utterance"] for line in b"".join(batch).splitlines()]
    assert said == ["find the bowl", "find the red cup"]

    settings.PARSER_SECRET = "another"
    refused = call({"utterance": "go"})
    assert refused.status_code == 503 and "PARSER_SECRET" in refused.content.decode()
    server.send_signal(signal.SIGTERM)
    assert server.wait(60) == 0


@pytest.mark.processes
def test_a_batch_whose_server_dies_ends_with_a_line_that_says_so(server, world, call):
    promote(trained_run(make_home(world)), None)
    wait_for(lambda: call({"utterance": "find the bowl"}).status_code == 200, "it is loaded")
    lines = b"".join(b'{"utterance": "find the bowl %d"}\n' % number for number in range(5_000))
    pieces = iter(call(lines, f"{PARSE}?beam=20", "application/jsonl").streaming_content)
    answered = [next(pieces)]
    server.kill()
    with pytest.raises(BrokenOff):
        for piece in pieces:
            answered.append(piece)
    last = json.loads(answered[-1])
    assert last["of"] == 5_000 and last["answered"] == len(answered) - 1 < 5_000
    assert AWAY in last["error"]


def test_an_answer_is_waited_for_however_many_connections_are_open():
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft < 2_000 <= hard:
        resource.setrlimit(resource.RLIMIT_NOFILE, (2_000, hard))
    near, far = socket.socketpair()
    connection = HTTPConnection("127.0.0.1")
    connection.sock = socket.socket(fileno=fcntl.fcntl(near.fileno(), fcntl.F_DUPFD, 1_500))
    far.sendall(b"HTTP/1.1 200 OK")
    try:
        ParserClient("http://127.0.0.1:1", "secret")._wait_for_answer(connection)
    finally:
        for each in (near, far, connection.sock):
            each.close()
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
