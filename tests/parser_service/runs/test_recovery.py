"""Workers that are killed or paused in the middle of a run: it ends as if nothing had happened."""

from __future__ import annotations

import signal
import time
from itertools import groupby

import pytest
from django.db import OperationalError, connection, transaction

from parser_service.models import TrainingRun, Worker
from parser_service.runs import lifecycle, run_requests
from parser_service.runs.train_run import train
from tests.parser_service.made_up import LONG, TINY
from tests.parser_service.worker_process import states, wait_for_epochs, wait_for_status
from tests.waiting import LOOK_EVERY, wait_for

pytestmark = [pytest.mark.processes, pytest.mark.django_db(transaction=True)]

SEED = 3
KNOWN: list[list[tuple[str, float]]] = []
SHORT = {**TINY, "epochs": 30, "patience": 30}


@pytest.fixture
def undisturbed(split) -> list[list[tuple[str, float]]]:
    """What a run comes to that nothing interrupts, without a worker. Trained for the first who asks."""
    if not KNOWN:
        KNOWN.extend(train_here(split))
    return KNOWN


def train_here(split) -> list[list[tuple[str, float]]]:
    run, _ = run_requests.request(split.world, split, "seq2seq", SHORT, seed=SEED, send=False)
    train(lifecycle.claim("the test", run.queue, run))
    answers = predicted(run)
    run.delete()
    return answers


def predicted(run) -> list[list[tuple[str, float]]]:
    """The ranked forms of every example, with their scores."""
    rows = run.predictions.order_by("example__source", "example__position", "rank")
    by_example = groupby(rows, key=lambda row: row.example_id)
    return [[(row.logical_form, row.score) for row in ranked] for _, ranked in by_example]


def kill_worker(worker) -> None:
    worker.kill_parent()


def kill_child(worker) -> None:
    worker.kill_child()


def kill_both(worker) -> None:
    worker.signal_all(signal.SIGKILL)


@pytest.mark.parametrize("kill", [kill_worker, kill_child, kill_both])
def test_a_killed_run_goes_on_to_the_same_result(world, split, undisturbed, start_worker, kill):
    worker = start_worker()
    run, _ = run_requests.request(world, split, "seq2seq", SHORT, seed=SEED)
    wait_for_epochs(run, 5)
    kill(worker)
    run.refresh_from_db()
    assert run.status == "running"
    epoch = run.checkpoints.order_by("epoch").last().epoch
    if kill is not kill_child:
        start_worker()
    wait_for_epochs(run, epoch + 1)
    wait_for_status(run, "succeeded")
    assert (run.attempt, run.resumes) == (2, 1)
    assert run.events.filter(message__startswith="Resuming after epoch").exists()
    assert list(run.epochs.values_list("epoch", flat=True)) == list(range(1, 31))
    assert predicted(run) == undisturbed


def test_a_child_does_not_outlive_its_killed_parent(world, split, start_worker):
    worker = start_worker()
    run, _ = run_requests.request(world, split, "seq2seq", LONG)
    wait_for_epochs(run, 1)
    children = worker.children()
    assert children
    worker.kill_parent()
    wait_for(lambda: not any(map(is_alive, children)), "the child is gone")


def is_alive(process: int) -> bool:
    """Whether the process runs; one that only its parent has not asked about yet does not."""
    return bool(states(process) - {"Z"})


def test_a_paused_worker_that_comes_back_late_writes_nothing(
    world, split, undisturbed, start_worker
):
    paused = start_worker()
    run, _ = run_requests.request(world, split, "seq2seq", SHORT, seed=SEED)
    wait_for_epochs(run, 5)
    pause_between_writes(paused, run)
    start_worker()
    wait_for(lambda: run.events.filter(attempt=2).exists(), "the other worker takes the run")
    paused.signal_all(signal.SIGCONT)
    wait_for_status(run, "succeeded")
    assert run.attempt == 2
    first_of_second = run.events.filter(attempt=2).first()
    assert not run.events.filter(attempt=1, id__gt=first_of_second.id).exists()
    assert list(run.epochs.values_list("epoch", flat=True)) == list(range(1, 31))
    assert predicted(run) == undisturbed


def pause_between_writes(worker, run) -> None:
    """Stops the worker's processes at a moment when none of them holds a lock that the run needs."""
    worker.pause()
    while not can_be_written(run):
        worker.signal_all(signal.SIGCONT)
        time.sleep(LOOK_EVERY)
        worker.pause()


def can_be_written(run) -> bool:
    """Whether nobody else holds a lock on the run now."""
    try:
        with connection.cursor() as cursor:
            if connection.vendor == "sqlite":
                cursor.execute("PRAGMA busy_timeout = 0")
        with transaction.atomic():
            TrainingRun.objects.select_for_update(nowait=True).get(pk=run.pk)
    except OperationalError:
        return False
    finally:
        connection.close()  # with it goes the pragma
    return True


def test_a_run_that_loses_three_workers_is_lost_and_says_what_to_do(world, split, start_worker):
    run, _ = run_requests.request(world, split, "seq2seq", LONG)
    worker = start_worker()
    for attempt in (1, 2, 3):
        wait_for(
            lambda number=attempt: run.events.filter(
                attempt=number, message__contains="begins on"
            ).exists(),
            f"attempt {attempt} begins",
        )
        worker.kill_child()
    wait_for_status(run, "lost")
    assert " 3 " in run.failure
    assert Worker.objects.alive()
