"""Runs of a parser that asks a language model: failing, going on, cancelling; and what of it is stored."""

from __future__ import annotations

import json
import logging
import threading
import time

import pytest
from django.apps import apps
from django.core import serializers

from annotations.language.texts.errors import Refusal
from annotations.models import JobKind
from parser_service.models import Promotion, TrainingRun
from parser_service.parsers.server_address import ModelServer
from parser_service.runs import lifecycle, run_requests
from parser_service.runs.checkpoints import model_folder
from parser_service.runs.promoting import promoted_run
from parser_service.runs.train_run import train
from parser_service.serving.default_runs import best_run
from tests.parser_service.llm_server import (
    KEY,
    MODEL,
    REPORTED,
    fails,
    installed,
    installed_tiny_server,
    says,
)
from tests.parser_service.runs.test_train_run import trained

pytestmark = pytest.mark.django_db(transaction=True)
CONFIG = {"model": MODEL, "at_once": 1}


@pytest.fixture
def tiny(tmp_path):
    with installed_tiny_server(tmp_path) as server:
        yield server


def asked_run(split, **changes) -> TrainingRun:
    return trained(split, "llm", config={**CONFIG, **changes}, train_sources="para")


def test_a_run_names_the_model_and_stores_its_answers_without_the_key(tiny, split, caplog):
    caplog.set_level(logging.DEBUG)
    tiny.always = says(f"{KEY} is your key")
    run = asked_run(split, decoding="free")
    assert (run.status, run.failure, run.answered_by) == ("succeeded", "", REPORTED)
    assert run.score_kind == "" and run.parameters == 0
    assert run.predictions.count() == run.split.examples.exclude(part="train").count()
    assert run.predictions.first().logical_form == "… is your key"
    assert run.events.filter(message__contains=f"answers with {REPORTED}").exists()
    rows = serializers.serialize(
        "json", [row for each in apps.get_models() for row in each.objects.all()]
    )
    files = "".join(path.read_text() for path in model_folder(run.pk).rglob("*.json"))
    assert "…" in rows
    assert KEY not in rows + files + caplog.text
    assert tiny.url not in rows + files
    assert all(KEY in json.dumps(each) for each in tiny.headers)


def test_a_server_that_fails_half_way_leaves_no_score_and_the_next_run_goes_on(tiny, split, caplog):
    tiny.faults = [*9 * [says('{"form": "UNKNOWN"}')], *9 * [fails(503, KEY)]]
    failed = asked_run(split)
    assert failed.status == "failed"
    assert "status 503, …" in failed.failure and " 3 " in failed.failure
    assert not failed.predictions.exists() and not failed.evaluations.exists()
    assert KEY not in caplog.text

    before = len(tiny.asked)
    tiny.faults.clear()
    run = asked_run(split)
    assert run.status == "succeeded"
    texts = {each.utterance for each in split.examples.exclude(part="train")}
    assert len(tiny.asked) == before + len(texts) - 9
    assert run.predictions.filter(logical_form="UNKNOWN").count() == 9


def test_a_repeated_run_asks_nothing_but_what_models_there_are(tiny, split):
    first = asked_run(split)
    asked = len(tiny.asked)
    TrainingRun.objects.filter(pk=first.pk).update(content_key="another")
    second = asked_run(split)
    assert second.pk != first.pk and len(tiny.asked) == asked
    answers = [
        list(run.predictions.values_list("example", "rank", "logical_form"))
        for run in (first, second)
    ]
    assert answers[0] == answers[1] and second.answered_by == REPORTED


def test_a_run_is_cancelled_in_the_middle_of_an_answer(tiny, split):
    tiny.seconds = 60
    run, _ = run_requests.request(
        split.world, split, "llm", config=CONFIG, train_sources="para", send=False
    )
    run = lifecycle.claim("the test", run.queue, run)
    threading.Timer(0.3, lifecycle.cancel, [run]).start()
    began = time.monotonic()
    train(run)
    run.refresh_from_db()
    assert run.status == "cancelled"
    assert time.monotonic() - began < 30


def test_a_run_waits_for_people_before_it_answers_or_is_analysed(tiny, split):
    right = dict(split.examples.values_list("utterance", "logical_form"))
    tiny.think = lambda body: right[body["messages"][-1]["content"]]
    run = asked_run(split, decoding="free")
    assert run.evaluations.filter(test_source="para", correct__gt=0).exists()
    assert promoted_run(run.world) is None and not Promotion.objects.exists()
    assert not run.world.jobs.filter(kind=JobKind.ANALYSE).exists()
    with pytest.raises(Refusal) as refused:
        best_run(run.world)
    assert refused.value.code == "no_succeeded_run"
    other = trained(split, "knn", train_sources="para")
    assert best_run(run.world) == other


@pytest.mark.parametrize(
    ("config", "server", "code", "named"),
    [
        ({}, None, "hyperparameter_missing", "model"),
        (CONFIG, ModelServer(), "requirement_missing", "GPSR_LLM_URL"),
        (CONFIG, ModelServer("http://192.0.2.7/v1"), "requirement_missing", "GPSR_LLM_REMOTE"),
    ],
)
def test_what_cannot_be_asked_is_refused_before_it_is_queued(
    tiny, split, config, server, code, named
):
    place = server or ModelServer(tiny.url)
    with installed(place), pytest.raises(Refusal, match=named) as refused:
        run_requests.request(split.world, split, "llm", config=config, send=False)
    assert refused.value.code == code
    assert not TrainingRun.objects.exists()
