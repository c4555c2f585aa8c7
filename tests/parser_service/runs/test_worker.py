"""A worker as a process: it trains what is queued, listens for cancels and stops in good order."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from annotations.background import send_wake_up
from parser_service.models import Worker
from parser_service.runs import lifecycle, run_requests
from tests.parser_service.made_up import LONG, TINY
from tests.parser_service.worker_process import ROOT, wait_for_epochs, wait_for_status
from tests.waiting import PATIENCE_SECONDS, wait_for

HAS_PROC = Path("/proc").is_dir()  # where the system tells what a process has loaded
pytestmark = [pytest.mark.processes, pytest.mark.django_db(transaction=True)]


def has_loaded_torch(process: int) -> bool:
    try:
        return "libtorch" in Path(f"/proc/{process}/maps").read_text()
    except FileNotFoundError:  # a child that has ended meanwhile
        return False


@pytest.fixture
def worker(start_worker):
    running = start_worker()
    wait_for(Worker.objects.alive, "the worker shows itself")
    return running


def test_a_worker_shows_that_it_lives_and_trains_what_is_asked_for(world, split, worker):
    run, _ = run_requests.request(world, split, "knn", train_sources="gen+para")
    wait_for_status(run, "succeeded")
    assert run.evaluations.count() == 6
    assert run.predictions.best().count() == 24
    assert worker.stop() == 0
    assert not Worker.objects.exists()


def test_the_timer_ticks_while_a_child_trains(world, split, worker):
    run, _ = run_requests.request(world, split, "seq2seq", LONG)
    wait_for_epochs(run, 1)
    seen = Worker.objects.get().last_seen
    wait_for(lambda: Worker.objects.get().last_seen > seen, "the worker's row is written")


def test_a_second_run_waits_for_the_first(world, split, worker):
    first, _ = run_requests.request(world, split, "seq2seq", {**TINY, "epochs": 20}, seed=1)
    second, _ = run_requests.request(world, split, "seq2seq", {**TINY, "epochs": 1}, seed=2)
    wait_for_status(second, "succeeded")
    first.refresh_from_db()
    assert first.status == "succeeded"
    assert first.finished_at < second.started_at
    if HAS_PROC:
        assert not has_loaded_torch(worker.pid)


def test_a_short_run_passes_a_long_one_in_a_process_without_torch(world, split, start_worker):
    training, quick = start_worker("cpu", "gpu"), start_worker("quick")
    wait_for(lambda: len(Worker.objects.alive()) == 2, "two workers show themselves")
    long, _ = run_requests.request(world, split, "seq2seq", LONG)
    wait_for_epochs(long, 1)
    short, _ = run_requests.request(world, split, "knn")
    wait_for_status(short, "succeeded")
    long.refresh_from_db()
    assert (long.status, long.worker.partition("-")[0]) == ("running", "cpu")
    assert short.worker.startswith("quick-")
    if HAS_PROC:
        assert any(map(has_loaded_torch, training.children()))
        assert not any(map(has_loaded_torch, [quick.pid, *quick.children()]))


def test_a_worker_without_a_queue_takes_all_work_in_turn(world, split, start_worker):
    runs = [
        run_requests.request(world, split, "seq2seq", {**TINY, "epochs": 2}, seed=seed)[0]
        for seed in range(2)
    ]
    runs.append(run_requests.request(world, split, "knn", send=False)[0])
    start_worker()
    for run in runs:
        wait_for_status(run, "succeeded")
    first, second, short = runs
    assert first.started_at < short.started_at < second.started_at


def test_cancelling_a_running_run_takes_effect_long_before_its_end(world, split, worker):
    run, _ = run_requests.request(world, split, "seq2seq", LONG)
    wait_for_epochs(run, 2)
    lifecycle.cancel(run)
    wait_for_status(run, "cancelled")
    assert run.epochs.count() < LONG["epochs"] / 10
    follower, _ = run_requests.request(world, split, "knn")
    wait_for_status(follower, "succeeded")


def test_stopping_the_service_hands_the_run_back_and_the_next_start_goes_on(
    world, split, start_worker
):
    first = start_worker()
    run, _ = run_requests.request(world, split, "seq2seq", LONG)
    wait_for_epochs(run, 3)
    assert first.stop() == 0
    run.refresh_from_db()
    assert (run.status, run.resumes) == ("queued", 0)
    epoch = run.checkpoints.order_by("epoch").last().epoch
    start_worker()
    wait_for_epochs(run, epoch + 1)
    assert run.events.filter(message=f"Resuming after epoch {epoch}.").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP, signal.SIGQUIT])
def test_every_way_to_stop_a_worker_is_a_stop_in_good_order(worker, number):
    worker.process.send_signal(number)
    assert worker.process.wait(PATIENCE_SECONDS) == 0
    assert not Worker.objects.exists()


def test_a_run_whose_message_was_lost_is_picked_up_by_the_timer(world, split, worker):
    seen = Worker.objects.get().last_seen
    wait_for(lambda: Worker.objects.get().last_seen > seen, "the first tick is over")
    run, _ = run_requests.request(world, split, "knn", send=False)
    wait_for_status(run, "succeeded")


def test_wake_ups_for_nothing_hold_nobody_up(world, split, worker):
    for queue in ("quick", "cpu", "gpu", "cpu"):
        send_wake_up(queue)
    run, _ = run_requests.request(world, split, "knn")
    wait_for_status(run, "succeeded")


def test_of_two_workers_racing_for_one_run_one_wins(world, split, start_worker):
    start_worker()
    start_worker()
    wait_for(lambda: len(Worker.objects.alive()) == 2, "two workers show themselves")
    for seed in range(4):
        run, _ = run_requests.request(world, split, "knn", seed=seed)
        send_wake_up("quick")
        wait_for_status(run, "succeeded")
        assert run.attempt == 1
        assert run.events.filter(message__contains="begins on").count() == 1


def test_a_broker_that_is_away_costs_a_line_in_the_log():
    script = (
        "import django; django.setup(); from annotations.background import send_wake_up; "
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
        timeout=PATIENCE_SECONDS,
        check=True,
    )
    assert "queue cpu" in told.stderr
