"""The parse server over HTTP."""

from __future__ import annotations

import io
import json
import re

import pytest

from parser_service.runs.promoting import promote
from parser_service.serving.application import ParseApplication
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import LINES_TOGETHER, Shelf
from tests.parser_service.served import make_home, trained_run

PARSE = "/api/v1/worlds/home/parse/"


@pytest.fixture
def shelf(world):
    promote(trained_run(make_home(world)), None)
    made = Shelf(10_000_000, Metrics())
    made.update()
    return made


@pytest.fixture
def ask(shelf):
    """Returns a function that sends a request and returns status, content type and body."""
    application = ParseApplication(shelf, "a secret", lambda: None)

    def send(path, body=b"", secret="a secret", method="POST", kind="application/json", query=""):
        said = {}
        environ = {
            "REQUEST_METHOD": method,
            "PATH_INFO": path,
            "QUERY_STRING": query,
            "CONTENT_TYPE": kind,
            "CONTENT_LENGTH": str(len(body)),
            "HTTP_AUTHORIZATION": f"Bearer {secret}",
            "wsgi.input": io.BytesIO(body),
        }
        chunks = application(
            environ, lambda status, headers: said.update(status=status, **dict(headers))
        )
        return int(said["status"].split()[0]), said["Content-Type"], b"".join(chunks)

    return send


def test_an_utterance_is_answered(ask):
    status, kind, body = ask(PARSE, b'{"utterance": "find the red cup", "beam": 2}')
    assert (status, kind) == (200, "application/json")
    answer = json.loads(body)
    assert answer["utterance"] == "find the red cup" and len(answer["candidates"]) == 2


def test_json_lines_are_answered_in_order_and_bad_ones_in_their_place(ask):
    lines = [json.dumps({"utterance": f"find the bowl {n}"}) for n in range(LINES_TOGETHER + 3)]
    lines[1:1] = ["nonsense", "", '{"utterance": ""}']
    status, kind, body = ask(PARSE, "\n".join(lines).encode(), kind="application/jsonl")
    answers = [json.loads(line) for line in body.splitlines()]
    assert (status, kind, len(answers)) == (200, "application/jsonl", len(lines) - 1)
    assert [each["line"] for each in answers[1:3]] == [2, 4]
    assert all(set(each) == {"line", "detail"} for each in answers[1:3])
    assert "JSON" in answers[1]["detail"] and "JSON" not in answers[2]["detail"]
    said = [answer["utterance"] for answer in answers if "utterance" in answer]
    assert said == [f"find the bowl {n}" for n in range(LINES_TOGETHER + 3)]


@pytest.mark.parametrize("path", [PARSE, "/metrics", "/api/v1/parsers/", "/nowhere"])
@pytest.mark.parametrize("secret", ["", "another", "é"])
def test_nothing_is_said_without_the_secret(ask, path, secret):
    assert ask(path, b'{"utterance": "go"}', secret)[0] == 401


def test_whether_it_lives_is_said_to_everybody(ask):
    status, _, body = ask("/healthz", secret="", method="GET")
    assert (status, json.loads(body)) == (200, {"status": "ok"})


def test_it_counts_for_prometheus(ask):
    ask(PARSE, b'{"utterance": "find the bowl"}')
    ask("/api/v1/worlds/moon/parse/", b'{"utterance": "find the bowl"}')
    text = ask("/metrics", method="GET")[2].decode()
    assert 'gpsr_parse_requests_total{status="200",world="home"} 1.0' in text
    assert 'gpsr_parse_requests_total{status="404",world=""} 1.0' in text
    assert "gpsr_parse_seconds_count 1.0" in text and "gpsr_parsers_loaded 1.0" in text


@pytest.mark.parametrize(
    ("body", "named"),
    [
        (b"", r"\bJSON\b"),
        (b"[" * 100_000, r"\bJSON\b"),
        (b'{"utterance": 3}', r"\butterance\b"),
        (b'{"utterance": "a\\u0000b"}', r"\bNUL\b"),
        (json.dumps({"utterance": "a" * 501}).encode(), r"\b500\b"),
        (b'{"utterance": "go", "beam": 0}', r"\b1\b.*\b20\b"),
        (b'{"utterance": "go", "beam": true}', r"\b1\b.*\b20\b"),
        (b'{"utterance": "go", "run": "x"}', r"\brun\b"),
    ],
)
def test_what_is_no_request_is_refused_with_what_is_wrong(ask, body, named):
    status, _, answer = ask(PARSE, body)
    assert status == 400 and re.search(named, json.loads(answer)["detail"])


def test_what_is_not_there_is_refused(ask):
    assert ask("/api/v1/worlds/moon/parse/", b'{"utterance": "go"}')[0] == 404
    assert ask("/nowhere")[0] == 404
    assert ask(PARSE, method="GET")[0] == 405
    assert ask(PARSE, b'{"utterance": "go", "run": 999}')[0] == 409
    assert ask(PARSE, b"{}", kind="application/jsonl", query="beam=x")[0] == 400


@pytest.mark.parametrize("query", ["beam=x", "run=x", "beam=0"])
def test_numbers_that_are_none_are_refused_in_words_of_ours(ask, query):
    status, _, answer = ask(PARSE, b"{}", kind="application/jsonl", query=query)
    said = json.loads(answer)["detail"]
    assert status == 400 and "run and beam" in said and "literal" not in said
