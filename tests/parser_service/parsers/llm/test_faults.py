"""What goes wrong between here and a language model's server: asked again, said in a sentence, never guessed."""

from __future__ import annotations

import json
import logging
import socket
import ssl
import subprocess
import time
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from email.utils import format_datetime
from shutil import which

import pytest

from parser_service.parsers.interface import Cancelled
from parser_service.parsers.llm import exchange
from parser_service.parsers.llm.asking import Asker
from parser_service.parsers.llm.places import Server
from parser_service.parsers.llm.protocol import Question
from tests.parser_service.llm_server import (
    KEY,
    MODEL,
    QUICK,
    cuts_the_body,
    drips,
    fails,
    hangs_up,
    says,
    sends,
    tiny_server,
)

SCHEMA = {"type": "object", "properties": {"form": {"enum": ["a", "UNKNOWN"]}}}
PASSING = {
    "busy": fails(429, "slow down"),
    "busy for a moment": fails(429, Retry_After="0"),
    "broken": fails(500, "CUDA error"),
    "starting": fails(503, "Loading model", Retry_After="0"),
    "hangs up": hangs_up,
    "cut": cuts_the_body,
    "no JSON": sends(b"<html>Bad gateway</html>"),
    "not the protocol": sends(b'{"choices": []}'),
    "an error within": sends(b'{"error": {"message": "upstream"}}'),
    "a list": sends(b"[1]"),
    "nothing": sends(b""),
    "no content": says(None),
    "content of another kind": says({"form": "a"}),
}


def question(text: str = "hello", schema=SCHEMA) -> Question:
    example = [{"role": "user", "content": "x"}, {"role": "assistant", "content": "a"}]
    messages = (*example, {"role": "user", "content": text})
    return Question(MODEL, messages, schema, 0, 100)


def ask(place: Server, *questions: Question, check=lambda: None, at_once: int = 4):
    return [each.text for each in Asker(place, at_once).ask(questions, check)]


def chats(tiny) -> int:
    return len(tiny.asked)


@pytest.mark.parametrize("fault", PASSING)
def test_what_passes_is_asked_again(place, tiny, fault):
    tiny.faults = 2 * [PASSING[fault]]
    assert ask(place, question()) == ["a"]
    assert chats(tiny) == 3


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("busy", "status 429, slow down"),
        ("broken", "status 500, CUDA error"),
        ("hangs up", "its answer was cut off or is not HTTP"),
        ("cut", "its answer was cut off"),
        ("no JSON", "its answer is not JSON"),
        ("an error within", "its answer is none of the protocol \\(upstream\\)"),
        ("no content", "its answer is none of the protocol"),
    ],
)
def test_what_does_not_pass_ends_in_a_sentence(place, tiny, fault, words):
    tiny.always = PASSING[fault]
    with pytest.raises(
        ValueError, match=f"does not answer: {words}.* It was asked 3 times"
    ) as caught:
        ask(place, question())
    assert "Answers that came are kept" in str(caught.value)
    assert chats(tiny) == 3


@pytest.mark.parametrize(
    ("status", "sentence"),
    [
        (401, "does not let us in \\(status 401, no\\). Set GPSR_LLM_KEY"),
        (403, "does not let us in"),
        (404, "has nothing at /v1/chat/completions"),
        (413, "refuses the question \\(status 413, no\\)"),
    ],
)
def test_what_cannot_pass_is_not_asked_again(place, tiny, status, sentence):
    tiny.always = fails(status, "no")
    with pytest.raises(ValueError, match=sentence):
        ask(place, question())
    assert chats(tiny) == 1


def test_a_server_that_is_away_is_said_to_be_so(tmp_path):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    place = Server(f"http://127.0.0.1:{port}", patience=QUICK)
    with pytest.raises(ValueError, match=f"127.0.0.1:{port} does not answer: connection refused"):
        ask(place, question())


def test_an_answer_that_takes_too_long_is_waited_for_no_longer(place, tiny):
    place = replace(place, patience=replace(QUICK, answer=0.3, tries=2))
    for fault in (drips, lambda handler: time.sleep(5)):
        tiny.always = fault
        began = time.monotonic()
        with pytest.raises(ValueError, match=r"does not answer: it took longer than 0.3 s"):
            ask(place, question())
        assert time.monotonic() - began < 3


def test_a_wait_that_the_server_asks_for_is_kept_but_not_a_long_one(place, tiny):
    tiny.faults = [fails(429, Retry_After="1")]
    began = time.monotonic()
    assert ask(place, question()) == ["a"]
    assert time.monotonic() - began >= 1

    in_an_hour = format_datetime(datetime.now(UTC) + timedelta(hours=1), usegmt=True)
    for wanted in ("3600", in_an_hour):
        tiny.always = fails(429, "quota", Retry_After=wanted)
        with pytest.raises(
            ValueError, match=r"asked again in 3,(600|59\d) s only \(status 429, quota"
        ):
            ask(place, question(wanted))
    assert chats(tiny) == 4


@pytest.mark.parametrize("fault", ["slow", "drips", "pauses"])
def test_stopping_takes_no_longer_than_the_check(place, tiny, fault):
    place = replace(place, patience=replace(QUICK, answer=60, first_pause=60, longest_pause=60))
    tiny.always = {
        "slow": lambda handler: time.sleep(20),
        "drips": drips,
        "pauses": fails(500),
    }[fault]
    until = time.monotonic() + 0.5

    def check() -> None:
        if time.monotonic() > until:
            raise Cancelled

    with pytest.raises(Cancelled):
        ask(place, *(question(str(number)) for number in range(9)), check=check)
    assert time.monotonic() - until < 1


def test_what_came_before_a_failure_is_not_asked_again(place, tiny):
    asked = [question(str(number)) for number in range(6)]
    tiny.faults = [*4 * [says("b")], *9 * [fails(500)]]
    with pytest.raises(ValueError, match=r"does not answer"):
        ask(place, *asked, at_once=1)
    tiny.faults.clear()
    before = chats(tiny)
    assert ask(place, *asked, at_once=1) == [*4 * ["b"], *2 * ["a"]]
    assert chats(tiny) == before + 2


def test_several_are_asked_at_once_and_answered_in_order(place, tiny):
    tiny.think, tiny.seconds = (lambda body: body["messages"][-1]["content"]), 0.1
    texts = [str(number) for number in range(12)]
    assert ask(place, *map(question, texts), at_once=4) == texts
    assert 2 <= tiny.most_at_once <= 4
    tiny.most_at_once = 0
    ask(place, *(question(f"{text}, one by one") for text in texts[:3]), at_once=1)
    assert tiny.most_at_once == 1


def test_the_same_question_is_asked_once(place, tiny):
    assert ask(place, question(), question("other"), question()) == ["a", "a", "a"]
    assert chats(tiny) == 2


def without_schema(handler) -> None:
    if "response_format" in handler.server.asked[-1]:
        return fails(400, "unknown field: response_format")(handler)
    return says("a")(handler)


def test_a_server_that_knows_no_schema_is_asked_without_and_the_log_says_so(place, tiny, caplog):
    tiny.always = without_schema
    asker = Asker(place, 1)
    assert [each.text for each in asker.ask([question(), question("b")], lambda: None)] == [
        "a",
        "a",
    ]
    assert ["response_format" in each for each in tiny.asked] == [True, False, False]
    [sentence] = asker.dialect.learned
    assert "does not take the JSON schema" in sentence and "unknown field" in sentence
    assert [record.message for record in caplog.records] == [sentence]


def test_a_question_that_is_refused_with_and_without_its_schema_is_refused(place, tiny):
    tiny.always = fails(400, "the prompt is longer than the context")
    with pytest.raises(ValueError, match=r"refuses the question .status 400, the prompt is longer"):
        ask(place, question())
    assert chats(tiny) == 2


def test_a_server_that_calls_the_limit_otherwise_is_understood(place, tiny):
    def only_completion_tokens(handler):
        if "max_tokens" in handler.server.asked[-1]:
            words = "Unsupported parameter: 'max_tokens'. Use 'max_completion_tokens' instead."
            return fails(400, words)(handler)
        return says("a")(handler)

    tiny.always = only_completion_tokens
    assert ask(place, question(), question("b"), at_once=1) == ["a", "a"]
    assert [each.get("max_completion_tokens") for each in tiny.asked] == [None, 100, 100]
    assert all("response_format" in each for each in tiny.asked)


def test_a_model_without_system_messages_is_told_the_task_by_the_person(place, tiny):
    def only_people(handler):
        if handler.server.asked[-1]["messages"][0]["role"] == "system":
            return fails(400, "System role not supported")(handler)
        return says("a")(handler)

    tiny.always = only_people
    asked = question()
    asked = replace(asked, messages=({"role": "system", "content": "Translate."}, *asked.messages))
    assert ask(place, asked) == ["a"]
    assert [each["role"] for each in tiny.asked[-1]["messages"]] == ["user", "assistant", "user"]
    assert tiny.asked[-1]["messages"][0]["content"] == "Translate.\n\nx"
    assert len(tiny.asked) == 2 and "response_format" in tiny.asked[-1]


def test_a_model_that_thinks_until_its_tokens_are_used_is_told_from_a_silent_one(place, tiny):
    tiny.faults = [says("", finish_reason="length")]
    with pytest.raises(
        ValueError, match=r"had used all its tokens before it answered. Raise max_to"
    ):
        ask(place, question())
    tiny.faults = [says(None, finish_reason="length", message={"reasoning_content": "Hmm"})]
    with pytest.raises(ValueError, match=r"had used all its tokens"):
        ask(place, question())
    tiny.faults = [says(None, message={"refusal": "I cannot help with that."})]
    assert ask(place, question()) == [""]


def test_content_in_parts_is_put_together(place, tiny):
    tiny.faults = [says([{"type": "text", "text": "a"}, {"type": "text", "text": "b"}])]
    assert ask(place, question()) == ["ab"]


def test_a_huge_answer_is_not_read_to_its_end(place, tiny):
    def endless(handler):
        handler.send_response(200)
        handler.send_header("Transfer-Encoding", "chunked")
        handler.end_headers()
        piece = 65536 * b"x"
        for _ in range(10_000):
            handler.wfile.write(b"10000\r\n" + piece + b"\r\n")

    tiny.always = endless
    with pytest.raises(ValueError, match=r"answers with more than 1,048,576 bytes"):
        ask(place, question())
    assert chats(tiny) == 1


@pytest.mark.parametrize("status", [301, 302, 307, 308])
def test_nothing_is_sent_where_a_redirect_leads(place, tiny, status):
    with tiny_server() as other:
        to = other.url.replace("127.0.0.1", "localhost")
        tiny.always = sends(b"", status, Location=f"{to}/chat/completions?secret=x")
        with pytest.raises(ValueError, match=r"sends the question to the host localhost") as caught:
            ask(place, question())
        assert other.asked == other.headers == []
    assert "secret" not in str(caught.value)
    tiny.always = sends(b"", status, Location="/v1/chat/completions/")
    with pytest.raises(ValueError, match=r"elsewhere on its own host"):
        ask(place, question())


def test_no_proxy_of_the_environment_is_used(place, tiny, monkeypatch):
    for name in ("http_proxy", "HTTP_PROXY", "all_proxy", "ALL_PROXY"):
        monkeypatch.setenv(name, "http://127.0.0.1:9/")
    monkeypatch.delenv("no_proxy", raising=False)
    assert ask(place, question()) == ["a"]


def test_the_key_is_sent_and_stands_nowhere_else(place, tiny, caplog, tmp_path):
    caplog.set_level(logging.DEBUG)
    told = []
    for body in (
        sends(json.dumps({"error": {"message": f"Wrong key Bearer {KEY}"}}).encode(), 401),
        fails(500, KEY),
        sends(KEY.encode()),
        sends(b"", 307, Location=f"http://{KEY}/"),
    ):
        tiny.always = body
        with pytest.raises(ValueError) as caught:
            ask(place, question())
        told.append(f"{caught.value!r} {caught.value.__cause__!r}")
    tiny.always, tiny.reports = says(f"your key is {KEY}"), KEY
    answers = Asker(place, 1).ask([question()], lambda: None)
    assert all(each["Authorization"] == f"Bearer {KEY}" for each in tiny.headers)
    files = [path.read_text() for path in (tmp_path / "llm").rglob("*.json")]
    assert len(files) == 1
    told += [*files, caplog.text, repr(place), str(place), repr(answers), repr(Asker(place, 1))]
    assert [text for text in told if KEY in text] == []


@pytest.fixture
def certified(tiny, tmp_path):
    """The server speaks HTTPS with a certificate that nobody vouches for; returns the file with it."""
    openssl = which("openssl")
    if openssl is None:
        pytest.skip("needs openssl, which makes a certificate")
    files = {name: tmp_path / f"{name}.pem" for name in ("keyout", "out")}
    named = [text for name, path in files.items() for text in (f"-{name}", str(path))]
    made_for = ["-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"]
    kind = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2"]
    run = [openssl, "req", "-x509", *kind, *made_for, *named]
    subprocess.run(run, check=True, capture_output=True)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(files["out"], files["keyout"])
    tiny.socket = context.wrap_socket(tiny.socket, server_side=True)
    return files["out"]


def test_a_certificate_is_looked_at_and_its_name_too(place, tiny, certified, monkeypatch):
    port = tiny.server_address[1]
    by_name = replace(place, url=f"https://localhost:{port}/v1")
    with pytest.raises(ValueError, match=r"certificate of localhost:\d+ is not to be trusted"):
        ask(by_name, question())
    monkeypatch.setenv("SSL_CERT_FILE", str(certified))
    assert ask(by_name, question()) == ["a"]
    with pytest.raises(ValueError, match=r"certificate of 127.0.0.1:\d+ is not to be trusted"):
        ask(replace(place, url=f"https://127.0.0.1:{port}/v1"), question("another"))
    assert len(tiny.asked) == 1


def test_a_name_that_leads_elsewhere_is_refused_after_it_is_looked_up(monkeypatch):
    def look_up(host, port, **_):
        return [
            (socket.AF_INET, socket.SOCK_STREAM, 6, "", ("127.0.0.1", port)),
            (socket.AF_INET, socket.SOCK_STREAM, 6, "", ("192.0.2.7", port)),
        ]

    monkeypatch.setattr(exchange.socket, "getaddrinfo", look_up)
    place = Server("http://models.example.org/v1", patience=QUICK)
    with pytest.raises(ValueError, match=r"is another machine.*Set GPSR_LLM_REMOTE=1"):
        ask(place, question())
    open_line = replace(place, key=KEY, may_be_remote=True)
    with pytest.raises(ValueError, match=r"GPSR_LLM_KEY would travel to models.example.org"):
        ask(open_line, question())
