"""A promoted parser that asks a language model: it answers, or a sentence does, and it delays nobody else."""

from __future__ import annotations

import io
import json
import threading
import time

import pytest

from parser_service.parsers.server_address import ModelServer
from parser_service.runs.promoting import promote
from parser_service.serving import remote
from parser_service.serving.application import ParseApplication
from parser_service.serving.metrics import Metrics
from parser_service.serving.parser_client import PATIENCE
from parser_service.serving.shelf import NotServed, Shelf
from tests.parser_service.live_server import parse_server  # noqa: F401
from tests.parser_service.llm_server import (
    KEY,
    MODEL,
    fails,
    installed,
    installed_tiny_server,
    repeat_the_last_example,
    says,
)
from tests.parser_service.made_up import make_split
from tests.parser_service.served import make_home, trained_run
from tests.waiting import PATIENCE_SECONDS, wait_for

FETCH = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'


@pytest.fixture
def tiny(tmp_path):
    with installed_tiny_server(tmp_path) as server:
        yield server


@pytest.fixture
def run(world, tiny):
    made = trained_run(make_home(world), parser="llm", config={"model": MODEL}, train_sources="gen")
    promote(made, None)
    return made


@pytest.fixture
def shelf(run):
    made = Shelf(10_000_000, Metrics())
    made.update()
    return made


def ask(shelf, utterance: str, world: str = "home") -> dict:
    return json.loads(shelf.find(world, None, 0).parse([utterance], 5)[0])


def test_a_promoted_language_model_answers_with_the_entities(shelf, run, tiny):
    answer = ask(shelf, "Bring me the red cup")
    assert (answer["run"], answer["parser"], answer["score_kind"]) == (run.pk, "llm", "")
    assert tiny.asked[-1]["messages"][-1]["content"] == "Bring me the red cup"
    [candidate] = answer["candidates"]
    assert candidate["english"] == "bring me the red cup"


def test_patience_ends_before_that_of_whoever_asks_the_parse_server():
    assert remote.PATIENCE < PATIENCE


def test_a_model_that_takes_too_long_ends_in_a_sentence(run, tiny):
    shelf = Shelf(10_000_000, Metrics(), patience=0.3)
    shelf.update()
    tiny.seconds = 30
    began = time.monotonic()
    with pytest.raises(NotServed, match=r"\b0\.3 s") as caught:
        ask(shelf, "bring me the bowl please")
    assert caught.value.status == 503 and time.monotonic() - began < 15


@pytest.mark.parametrize(
    ("fault", "status"),
    [(fails(401), 401), (fails(500), 500)],
)
def test_a_server_that_fails_is_a_sentence_and_a_later_question_is_answered(
    shelf, tiny, fault, status
):
    tiny.always = fault
    with pytest.raises(NotServed, match=rf"\bstatus {status}\b"):
        ask(shelf, "bring me the bowl please")
    tiny.always = None
    assert ask(shelf, "bring me the bowl please")["is_unknown"] is False


def test_an_installation_without_a_server_says_so(shelf):
    with installed(ModelServer()):
        other = Shelf(10_000_000, Metrics())
        other.update()
        with pytest.raises(NotServed, match="GPSR_LLM_URL"):
            ask(other, "bring me the bowl please")


def test_other_parsers_answer_while_it_waits_and_too_many_are_refused(
    shelf, tiny, django_user_model, monkeypatch
):
    from annotations.models import World

    moon = World.objects.create(name="moon")
    promote(trained_run(make_split(moon, "moon")), None)
    shelf.update()
    service, near = shelf.find("home", None, 0), shelf.find("moon", None, 0)
    answers_come = threading.Event()

    def think(body: dict) -> str:
        answers_come.wait(PATIENCE_SECONDS)
        return repeat_the_last_example(body)

    tiny.think = think
    texts = [f"bring me the bowl {number}" for number in range(remote.SEATS)]
    threads = [threading.Thread(target=service.parse, args=[[text], 1]) for text in texts]
    for thread in threads:
        thread.start()
    wait_for(lambda: tiny.now == remote.SEATS, "all seats are taken")
    near.parse(["find the object"], 1)
    with pytest.raises(NotServed, match=rf"\b{remote.SEATS}\b") as refused:
        service.parse(["one too many"], 1)
    assert refused.value.status == 503
    assert tiny.now == remote.SEATS
    answers_come.set()
    for thread in threads:
        thread.join()
    assert len(service.parse(["one too many"], 1)) == 1


def test_lines_are_answered_in_parts_and_those_without_an_answer_say_why(shelf, tiny):
    application = ParseApplication(shelf, "a secret", lambda: None)
    lines = [json.dumps({"utterance": f"bring me the bowl {number}"}) for number in range(6)]
    body = "\n".join(lines).encode()
    tiny.faults = remote.TOGETHER * [says(json.dumps({"form": FETCH}))]
    tiny.always = fails(403)
    environ = {
        "REQUEST_METHOD": "POST",
        "PATH_INFO": "/api/v1/worlds/home/parse/",
        "CONTENT_TYPE": "application/jsonl",
        "CONTENT_LENGTH": str(len(body)),
        "HTTP_AUTHORIZATION": "Bearer a secret",
        "wsgi.input": io.BytesIO(body),
    }
    chunks = list(application(environ, lambda *_: None))
    answers = [json.loads(line) for line in b"".join(chunks).splitlines()]
    assert len(chunks) == 2
    assert [each.get("is_unknown") for each in answers] == [*4 * [False], None, None]
    assert answers[-1]["line"] == 6 and "403" in answers[-1]["detail"]
    assert KEY not in str(answers)


def test_the_playground_shows_the_answer_or_the_sentence(run, tiny, anna, parse_server):  # noqa: F811
    parse_server.update()
    page = anna.post("/w/home/parse/ask/", {"text": "Bring me the red cup"}).content.decode()
    assert "bring me the red cup" in page and "<meter" not in page
    tiny.always = fails(500, "CUDA error")
    page = anna.post("/w/home/parse/ask/", {"text": "Bring me the bowl now"}).content.decode()
    assert "status 500, CUDA error" in page and 'role="alert"' in page
