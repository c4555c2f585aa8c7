"""A worker as a process: it trains what is queued, listens for cancels and stops in good order."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from parser_service import lifecycle, requesting
from parser_service.models import Worker
from parser_service.waking import send_wake_up
from tests.parser_service.made_up import LONG, TINY
from tests.parser_service.running import ROOT, wait_for, wait_for_epochs, wait_for_status

pytestmark = [pytest.mark.processes, pytest.mark.django_db(transaction=True)]


@pytest.fixture
def worker(start_worker):
    running = start_worker()
    wait_for(Worker.objects.alive().exists, 15, "the worker shows itself")
    return running


def test_a_worker_shows_that_it_lives_and_trains_what_is_asked_for(world, split, worker):
    run, _ = requesting.request(world, split, "knn", train_sources="gen+para")
    wait_for_status(run, "succeeded", 15)
    assert run.evaluations.count() == 6
    assert run.predictions.best().count() == 24
    assert worker.stop() < 5
    assert not Worker.objects.exists()


def test_the_timer_ticks_while_a_child_trains(world, split, worker):
    run, _ = requesting.request(world, split, "seq2seq", LONG)
    wait_for_epochs(run, 1)
    seen = Worker.objects.get().last_seen
    wait_for(lambda: Worker.objects.get().last_seen > seen, 3, "the worker's row is written")


def test_a_second_run_waits_for_the_first(world, split, worker):
    first, _ = requesting.request(world, split, "seq2seq", {**TINY, "epochs": 20}, seed=1)
    second, _ = requesting.request(world, split, "knn")
    wait_for_status(second, "succeeded", 60)
    first.refresh_from_db()
    assert first.status == "succeeded"
    assert first.finished_at < second.started_at
    if Path("/proc").is_dir():  # where the system tells what a process has loaded
        assert "libtorch" not in Path(f"/proc/{worker.pid}/maps").read_text()


def test_cancelling_a_running_run_takes_effect_within_five_seconds(world, split, worker):
    run, _ = requesting.request(world, split, "seq2seq", LONG)
    wait_for_epochs(run, 2)
    lifecycle.cancel(run)
    assert wait_for_status(run, "cancelled", 5) < 5
    assert run.finished_at is not None
    follower, _ = requesting.request(world, split, "knn")
    wait_for_status(follower, "succeeded", 15)


def test_stopping_the_service_hands_the_run_back_and_the_next_start_goes_on(
    world, split, start_worker
):
    first = start_worker()
    run, _ = requesting.request(world, split, "seq2seq", LONG)
    wait_for_epochs(run, 3)
    assert first.stop() < 5
    run.refresh_from_db()
    assert (run.status, run.resumes) == ("queued", 0)
    epoch = run.checkpoints.order_by("epoch").last().epoch
    start_worker()
    wait_for_epochs(run, epoch + 1, seconds=15)
    assert run.events.filter(message=f"Training goes on after epoch {epoch}.").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP, signal.SIGQUIT])
def test_every_way_to_stop_a_worker_is_a_stop_in_good_order(worker, number):
    worker.process.send_signal(number)
    assert worker.process.wait(timeout=5) == 0
    assert not Worker.objects.exists()


def test_a_run_whose_message_was_lost_is_picked_up_by_the_timer(world, split, worker):
    seen = Worker.objects.get().last_seen
    wait_for(lambda: Worker.objects.get().last_seen > seen, 5, "the first tick is over")
    run, _ = requesting.request(world, split, "knn", send=False)
    wait_for_status(run, "succeeded", 15)


def test_a_wake_up_for_nothing_does_nothing(world, split, worker):
    send_wake_up("cpu")
    run, _ = requesting.request(world, split, "knn")
    wait_for_status(run, "succeeded", 15)


def test_of_two_workers_racing_for_one_run_one_wins(world, split, start_worker):
    start_worker()
    start_worker()
    wait_for(lambda: Worker.objects.alive().count() == 2, 15, "two workers show themselves")
    for seed in range(4):
        run, _ = requesting.request(world, split, "knn", seed=seed)
        send_wake_up("cpu")
        wait_for_status(run, "succeeded", 15)
        assert run.attempt == 1
        assert run.events.filter(message__contains="begins on").count() == 1


def test_a_broker_that_is_away_costs_a_line_in_the_log():
    script = (
        "import django; django.setup(); from parser_service.waking import send_wake_up; "
        "send_wake_up('cpu')"
    )
    nobody = {"CELERY_BROKER_URL": "amqp://guest@127.0.0.1:1//"}
    settings = {"DJANGO_SETTINGS_MODULE": "gpsr_site.settings"}
    told = subprocess.run(
        [sys.executable, "-c", script],
        cwd=ROOT,
        env={**os.environ, **settings, **nobody},
        capture_output=True,
        text=True,
        timeout=15,
        check=True,
    )
    assert "No wake-up went to queue cpu" in told.stderr
