"""What goes wrong between here and a language model's server: asked again, said in a sentence, never guessed."""

from __future__ import annotations

import socket
import time
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from email.utils import format_datetime

import pytest

from annotations.language.texts.errors import Refusal
from parser_service.parsers.interface import Cancelled
from parser_service.parsers.model_server.asker import Asker
from parser_service.parsers.model_server.exchange import NoAnswer, ServerRefusal
from parser_service.parsers.model_server.protocol import ModelAnswer
from parser_service.parsers.server_address import ModelServer
from tests.parser_service.llm_server import (
    QUICK,
    cuts_the_body,
    drips,
    fails,
    hangs_up,
    says,
    sends,
)
from tests.parser_service.parsers.model_server.questions import ask, question

# Seconds that no test waits, however slow the machine; what waits for them has failed.
LONG = 30

PASSING = {
    "busy": fails(429, "slow down"),
    "busy for a moment": fails(429, Retry_After="0"),
    "broken": fails(500, "CUDA error"),
    "starting": fails(503, "Loading model", Retry_After="0"),
    "busy until a year without end": fails(503, Retry_After=f"Mon, 01 Jan {'9' * 20} 00:00:00 GMT"),
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


@pytest.mark.parametrize("fault", PASSING)
def test_what_passes_is_asked_again(place, tiny, fault):
    tiny.faults = 2 * [PASSING[fault]]
    assert ask(place, question()) == ["a"]
    assert len(tiny.asked) == 3


@pytest.mark.parametrize(
    ("fault", "named"),
    [
        ("busy", "429, slow down"),
        ("broken", "500, CUDA error"),
        ("hangs up", "HTTP"),
        ("cut", ""),
        ("no JSON", "JSON"),
        ("an error within", r"\(upstream\)"),
        ("no content", ""),
    ],
)
def test_what_does_not_pass_ends_in_a_sentence(place, tiny, fault, named):
    tiny.always = PASSING[fault]
    with pytest.raises(Refusal, match=rf"{place.name}.*{named}.*\b3\b") as caught:
        ask(place, question())
    assert caught.value.code == "language_model_refused"
    assert len(tiny.asked) == 3


@pytest.mark.parametrize(
    ("status", "named"),
    [
        (401, r"\(status 401, no\).*GPSR_LLM_KEY"),
        (403, r"\(status 403, no\).*GPSR_LLM_KEY"),
        (404, r"/v1/chat/completions \(status 404, no\).*GPSR_LLM_URL"),
        (413, r"\(status 413, no\)"),
    ],
)
def test_what_cannot_pass_is_not_asked_again(place, tiny, status, named):
    tiny.always = fails(status, "no")
    with pytest.raises(Refusal, match=named) as refused:
        ask(place, question())
    assert refused.value.code == "language_model_refused"
    assert len(tiny.asked) == 1


def test_a_server_that_is_away_is_said_to_be_so(tmp_path):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    place = ModelServer(f"http://127.0.0.1:{port}", patience=QUICK)
    with pytest.raises(Refusal, match=f"127.0.0.1:{port} .*connection refused") as refused:
        ask(place, question())
    assert refused.value.code == "language_model_refused"


def test_an_answer_that_takes_too_long_is_waited_for_no_longer(place, tiny):
    place = replace(place, patience=replace(QUICK, answer=0.3, tries=2))
    for fault in (drips, lambda handler: time.sleep(LONG)):
        tiny.always = fault
        began = time.monotonic()
        with pytest.raises(Refusal, match=r"\b0\.3 s") as refused:
            ask(place, question())
        assert refused.value.code == "language_model_refused"
        assert time.monotonic() - began < LONG


def test_a_wait_that_the_server_asks_for_is_kept_but_not_a_long_one(place, tiny):
    tiny.faults = [fails(429, Retry_After="1")]
    began = time.monotonic()
    assert ask(place, question()) == ["a"]
    assert time.monotonic() - began >= 1

    in_an_hour = format_datetime(datetime.now(UTC) + timedelta(hours=1), usegmt=True)
    for wanted in ("3600", in_an_hour):
        tiny.always = fails(429, "quota", Retry_After=wanted)
        with pytest.raises(Refusal, match=r"\b3,(600|59\d) s .*\(status 429, quota") as refused:
            ask(place, question(wanted))
        assert refused.value.code == "language_model_refused"
    assert len(tiny.asked) == 4


@pytest.mark.parametrize("fault", ["slow", "drips", "pauses"])
def test_stopping_takes_no_longer_than_the_check(place, tiny, fault):
    place = replace(
        place, patience=replace(QUICK, answer=LONG, first_pause=LONG, longest_pause=LONG)
    )
    tiny.always = {
        "slow": lambda handler: time.sleep(LONG),
        "drips": drips,
        "pauses": fails(500),
    }[fault]
    until = time.monotonic() + 0.5

    def check() -> None:
        if time.monotonic() > until:
            raise Cancelled

    with pytest.raises(Cancelled):
        ask(place, *(question(str(number)) for number in range(9)), check=check)
    assert time.monotonic() - until < LONG / 2


def test_what_came_before_a_failure_is_not_asked_again(place, tiny):
    asked = [question(str(number)) for number in range(6)]
    tiny.faults = [*4 * [says("b")], *9 * [fails(500)]]
    with pytest.raises(Refusal, match=r"\b500\b") as refused:
        ask(place, *asked, at_once=1)
    assert refused.value.code == "language_model_refused"
    tiny.faults.clear()
    before = len(tiny.asked)
    assert ask(place, *asked, at_once=1) == [*4 * ["b"], *2 * ["a"]]
    assert len(tiny.asked) == before + 2


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
    assert len(tiny.asked) == 2


def test_a_huge_answer_is_not_read_to_its_end(place, tiny):
    def endless(handler):
        handler.send_response(200)
        handler.send_header("Transfer-Encoding", "chunked")
        handler.end_headers()
        piece = 65536 * b"x"
        for _ in range(10_000):
            handler.wfile.write(b"10000\r\n" + piece + b"\r\n")

    tiny.always = endless
    with pytest.raises(Refusal, match="1,048,576") as refused:
        ask(place, question())
    assert refused.value.code == "language_model_refused"
    assert len(tiny.asked) == 1


def test_each_question_has_its_answer_or_its_fault(place, tiny):
    def answer(handler):
        if "bad" in handler.body["messages"][-1]["content"]:
            return fails(500, "CUDA error")(handler)
        return says("a")(handler)

    tiny.always = answer
    asker = Asker(place, 4)
    outcomes = asker.ask_each([question("one"), question("bad"), question("two")], lambda: None)
    assert [type(each) for each in outcomes] == [ModelAnswer, NoAnswer, ModelAnswer]
    asked = len(tiny.asked)
    asker.ask_each([question("one"), question("two")], lambda: None)
    assert len(tiny.asked) == asked


def test_a_server_that_lets_nobody_in_ends_all_questions(place, tiny):
    tiny.always = fails(401)
    with pytest.raises(ServerRefusal) as refused:
        Asker(place, 2).ask_each([question("one"), question("two")], lambda: None)
    assert not isinstance(refused.value, NoAnswer)


def test_a_question_has_its_temperature(place, tiny):
    ask(place, replace(question(), temperature=0.7))
    ask(place, question())
    assert [each["temperature"] for each in tiny.asked] == [0.7, 0]
