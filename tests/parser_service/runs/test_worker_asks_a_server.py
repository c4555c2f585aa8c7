"""A worker as a process asks the language model's server of its environment."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from parser_service.models import Worker
from parser_service.parsers.server_address import ModelServer
from parser_service.runs import lifecycle, run_requests
from tests.parser_service.llm_server import KEY, MODEL, REPORTED, fails, installed, tiny_server
from tests.parser_service.runs.test_worker import has_loaded_torch
from tests.parser_service.worker_process import wait_for_status
from tests.waiting import wait_for

pytestmark = [pytest.mark.processes, pytest.mark.django_db(transaction=True)]


def test_runs_end_or_stop_without_torch_and_the_key_is_in_no_log(
    world, split, start_worker, monkeypatch
):
    with tiny_server() as tiny, installed(ModelServer(tiny.url, KEY)):
        monkeypatch.setenv("GPSR_LLM_URL", tiny.url)
        monkeypatch.setenv("GPSR_LLM_KEY", KEY)
        monkeypatch.setenv("LOG_LEVEL", "DEBUG")
        worker = start_worker("cpu")
        wait_for(Worker.objects.alive, "the worker shows itself")

        def ask(seed: int):
            return run_requests.request(world, split, "llm", {"model": MODEL}, seed=seed)[0]

        tiny.always = fails(401, f"Wrong key: {KEY}")
        refused = ask(0)
        wait_for_status(refused, "failed")
        assert "(status 401, Wrong key: …)" in refused.failure

        tiny.always, tiny.seconds = None, 60
        cancelled = ask(1)
        wait_for(lambda: tiny.now > 0, "the server is asked")
        if Path("/proc").is_dir():
            assert not any(map(has_loaded_torch, worker.children()))
        began = time.monotonic()
        lifecycle.cancel(cancelled)
        wait_for_status(cancelled, "cancelled")
        assert time.monotonic() - began < 30

        tiny.seconds = 0
        run = ask(2)
        wait_for_status(run, "succeeded")
        assert run.answered_by == REPORTED
        assert worker.stop() == 0
    assert all(each["Authorization"] == f"Bearer {KEY}" for each in tiny.headers)
    log = worker.log.read_text(encoding="utf-8")
    assert "status 401" in log and KEY not in log
