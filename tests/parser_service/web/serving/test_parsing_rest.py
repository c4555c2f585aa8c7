"""Batches over REST: what is too much, what breaks off, and what one bad line costs."""

from __future__ import annotations

import json
import os
import time
from datetime import timedelta

import pytest

from annotations import background
from annotations.background.carrying_out_jobs import carry_out
from annotations.background.job_files import results_folder
from annotations.background.sweeping import sweep
from annotations.background.watching import JobProgress
from annotations.exchange.generator_import import import_generator
from annotations.models import ApiToken, Job
from annotations.web.rest.streaming import BrokenOff
from parser_service.runs.promoting import promote
from parser_service.serving.answerer import LINES_TOGETHER
from parser_service.serving.batch_requests import MOST_AT_ONCE
from parser_service.serving.shelf import Shelf
from parser_service.web.serving import parsing_rest
from parser_service.web.serving.parsing_rest import MOST_LINES
from tests.annotations.conftest import TINY, as_bytes
from tests.parser_service.live_server import parse_server  # noqa: F401  a fixture
from tests.parser_service.llm_server import MODEL, installed_tiny_server
from tests.parser_service.served import make_home, trained_run

PARSE = "/api/v1/worlds/home/parse/"
BOWL = b'{"utterance": "find the bowl"}\n'


@pytest.fixture
def send(request, client, world, annotator):
    """Returns a function that posts JSON lines with a token that may only read."""
    promote(trained_run(make_home(world)), None)
    request.getfixturevalue("parse_server").update()
    _, key = ApiToken.issue(annotator, "robot", scope="read")

    def post(lines: bytes):
        headers = {"authorization": f"Bearer {key}"}
        return client.post(PARSE, lines, content_type="application/jsonl", headers=headers)

    return post


def answers_of(answer) -> list[dict]:
    return [json.loads(line) for line in b"".join(answer.streaming_content).splitlines()]


def test_half_a_character_costs_its_own_line_alone(send):
    half = b'{"utterance": "find \\ud83d the bowl"}\n'
    first, second, third = answers_of(send(BOWL + half + BOWL))
    assert first["utterance"] == third["utterance"] == "find the bowl"
    assert second["line"] == 2 and "half a character" in second["detail"]


@pytest.mark.parametrize(
    "line", [b"\xff\xfe\n", b"[]\n", b'{"utterance": 7}\n', b"[" * 100_000 + b"\n", b'{"a": NaN}\n']
)
def test_a_line_that_is_no_utterance_costs_itself_alone(send, line):
    first, second = answers_of(send(line + BOWL))
    assert first["line"] == 1 and second["utterance"] == "find the bowl"


def test_more_lines_than_a_request_may_bring_are_refused_whole(send):
    assert send(BOWL * MOST_LINES).status_code == 200
    answer = send(BOWL * (MOST_LINES + 1))
    assert answer.status_code == 413
    assert "parse/jobs/" in answer.json()["detail"]
    assert send(b"\n" * (MOST_LINES + 1) + BOWL).status_code == 200  # empty lines are none


def test_a_batch_that_takes_too_long_says_how_far_it_came(send, monkeypatch):
    answer = send(BOWL * 3)
    assert len(answers_of(answer)) == 3
    monkeypatch.setattr(parsing_rest, "MOST_SECONDS", 0)
    pieces, answered = iter(send(BOWL * 200).streaming_content), []
    with pytest.raises(BrokenOff):
        for piece in pieces:
            answered += [json.loads(line) for line in piece.splitlines()]
    *_, last = answered
    assert last["of"] == 200 and last["answered"] == len(answered) - 1 < 200
    assert "stopped" in last["error"]


@pytest.fixture
def ask(client, annotator, settings, tmp_path):
    """Returns a function that asks REST as the annotator, with files in a folder of the test."""
    settings.VAR_DIR = tmp_path
    _, key = ApiToken.issue(annotator, "notebook", scope="annotate")

    def send(method: str, path: str, lines: bytes | None = None):
        headers = {"authorization": f"Bearer {key}"}
        return getattr(client, method)(
            f"/api/v1/worlds/home/{path}", lines, content_type="application/jsonl", headers=headers
        )

    return send


def carry_out_next() -> Job:
    job = background.claim("a worker", "quick", Job)
    carry_out(job)
    job.refresh_from_db()
    return job


def test_a_worker_parses_a_batch_and_its_answers_are_downloaded(world, ask):
    run = trained_run(make_home(world))
    asked = ask("post", f"parse/jobs/?beam=2&run={run.pk}", BOWL * 100 + b"nonsense\n\n" + BOWL)
    assert asked.status_code == 202
    path = f"jobs/{asked.json()['id']}/"
    assert ask("get", f"{path}result/").status_code == 409  # too early
    assert carry_out_next().report == {"lines": 102, "run": run.pk, "parser": "knn"}
    assert ask("get", path).json()["status"] == "succeeded"
    answers = answers_of(ask("get", f"{path}result/"))
    assert len(answers) == 102 and answers[100]["line"] == 101
    assert len(answers[101]["candidates"]) == 2


def test_a_batch_says_how_far_it_is_and_leaves_its_result_alone(world, ask, monkeypatch):
    reported, report = [], JobProgress.report

    def note(progress, fraction, activity):
        reported.append(fraction)
        report(progress, fraction, activity)

    monkeypatch.setattr(JobProgress, "report", note)
    run = trained_run(make_home(world))
    job = ask("post", f"parse/jobs/?run={run.pk}", BOWL * 3 * LINES_TOGETHER).json()["id"]
    assert carry_out_next().status == "succeeded"
    assert reported == pytest.approx([0, 1 / 3, 2 / 3, 1])
    assert [each.name for each in results_folder().iterdir()] == [f"{job}.jsonl"]
    assert results_folder().stat().st_mode & 0o077 == 0  # nobody else's


def test_a_batch_that_is_cancelled_leaves_no_half_result(world, ask, monkeypatch):
    report = JobProgress.report

    def stop(progress, fraction, activity):
        if fraction:
            raise background.Stopped
        report(progress, fraction, activity)

    monkeypatch.setattr(JobProgress, "report", stop)
    run = trained_run(make_home(world))
    ask("post", f"parse/jobs/?run={run.pk}", BOWL)
    assert carry_out_next().status == "cancelled"
    assert list(results_folder().iterdir()) == []


def test_a_language_model_may_take_its_time_for_a_batch(world, ask, tmp_path, monkeypatch):
    with installed_tiny_server(tmp_path) as tiny:
        run = trained_run(
            make_home(world), parser="llm", config={"model": MODEL}, train_sources="gen"
        )
        tiny.seconds = 0.5
        monkeypatch.setattr(Shelf.__init__, "__defaults__", (0.1,))  # as long as requests wait
        asked = ask("post", f"parse/jobs/?beam=1&run={run.pk}", BOWL)
        assert carry_out_next().status == "succeeded"
        (answer,) = answers_of(ask("get", f"jobs/{asked.json()['id']}/result/"))
        assert answer["utterance"] == "find the bowl" and answer["candidates"]


def test_a_worker_answers_as_the_parse_server_does(world, ask, send):
    lines = BOWL + b'{"utterance": "find the flurb"}\n{"utterance": "\\ud83d"}\n'
    at_once = answers_of(send(lines))
    key = ask("post", "parse/jobs/", lines).json()["id"]
    carry_out_next()
    assert answers_of(ask("get", f"jobs/{key}/result/")) == at_once


def test_a_worker_parses_with_the_grammar_oracle_without_a_run(world, ask):
    assert not import_generator(world.name, as_bytes(TINY)).problems
    lines = b'{"command": "find the tea"}\n{"utterance": "sing"}\n'
    assert ask("post", "parse/jobs/?parser=knn", lines).status_code == 400
    assert ask("post", "parse/jobs/?parser=grammar-oracle&run=1", lines).status_code == 400
    asked = ask("post", "parse/jobs/?parser=grammar-oracle", lines)
    report = {"lines": 2, "run": None, "parser": "grammar-oracle"}
    assert (asked.status_code, carry_out_next().report) == (202, report)
    first, second = answers_of(ask("get", f"jobs/{asked.json()['id']}/result/"))
    assert (first["run"], first["is_unknown"], second["is_unknown"]) == (None, False, True)


def test_a_batch_that_nothing_answers_fails_with_a_sentence(world, ask):
    make_home(world)
    ask("post", "parse/jobs/", BOWL)
    job = carry_out_next()
    assert job.status == "failed" and "home" in job.failure
    assert ask("post", "parse/jobs/", b" \n").status_code == 400
    assert ask("post", "parse/jobs/?beam=99", BOWL).status_code == 400


def test_nobody_fills_the_queue_with_batches(world, ask):
    for _ in range(MOST_AT_ONCE):
        assert ask("post", "parse/jobs/", BOWL).status_code == 202
    assert ask("post", "parse/jobs/", BOWL).status_code == 409


def test_results_are_swept_after_a_week(world, ask):
    run = trained_run(make_home(world))
    job = ask("post", f"parse/jobs/?run={run.pk}", BOWL).json()["id"]
    carry_out_next()
    (file,) = results_folder().iterdir()
    sweep()
    assert file.exists()
    old = time.time() - timedelta(days=8).total_seconds()
    os.utime(file, (old, old))
    sweep()
    assert list(results_folder().iterdir()) == []
    assert "a week ago" in ask("get", f"jobs/{job}/result/").json()["detail"]
