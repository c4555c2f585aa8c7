"""Who may change what of a run, and when."""

from __future__ import annotations

from datetime import timedelta

import pytest
from django.utils import timezone

from annotations.background import claim_in_turn, finish, wake_for_forgotten
from annotations.language.texts.errors import Refusal
from parser_service.models import Checkpoint, TrainingRun
from parser_service.parsers.interface import EpochReport
from parser_service.runs import lifecycle
from parser_service.runs.lifecycle import Fenced
from tests.parser_service.requests import ask, at_once, claim

REPORT = EpochReport(1, 0.5, 0.4, 0.75, 1.0)


def expire(run: TrainingRun) -> None:
    TrainingRun.objects.filter(pk=run.pk).update(lease_until=timezone.now() - timedelta(seconds=1))


# --- claiming -------------------------------------------------------------------------------------


def test_the_oldest_queued_run_is_claimed_first_and_once(split):
    first, second = ask(split, seed=1), ask(split, seed=2)
    assert [claim(), claim()] == [first, second]
    assert lifecycle.claim("cpu-2@here", "quick") is None


def test_a_claim_raises_the_attempt_and_begins_a_lease(split):
    ask(split)
    run = claim()
    assert (run.status, run.attempt, run.worker) == ("running", 1, "cpu-1@here")
    assert timezone.now() < run.lease_until <= timezone.now() + lifecycle.LEASE
    assert run.events.get().message == "Attempt 1 begins on cpu-1@here."


def test_a_worker_claims_from_its_own_queue_only(split):
    ask(split)
    assert lifecycle.claim("gpu-1@here", "gpu") is None


def test_a_worker_of_several_queues_takes_from_them_in_turn(split):
    """However many wait in one queue: each of the others has its turn after one of them."""
    long = [ask(split, parser="seq2seq", seed=seed) for seed in range(4)]
    short = [ask(split, seed=seed) for seed in range(2)]
    taken = []
    while work := claim_in_turn("all-1@here", ["cpu", "gpu", "quick"]):
        finish(work)
        taken.append(work)
    assert taken == [long[0], short[0], long[1], short[1], long[2], long[3]]


@pytest.mark.django_db(transaction=True)
def test_of_many_who_claim_one_run_one_wins(split):
    ask(split)
    claims = at_once(lambda number: lifecycle.claim(f"cpu-{number}@here", "quick"))
    assert len([run for run in claims if run]) == 1
    assert TrainingRun.objects.get().attempt == 1


# --- fencing --------------------------------------------------------------------------------------


WRITES = {
    "extend": lifecycle.extend,
    "progress": lambda run: lifecycle.record_progress(run, 0.5, "training"),
    "log": lambda run: lifecycle.log(run, "hello"),
    "epoch": lambda run: lifecycle.record_epoch(run, REPORT),
    "checkpoint": lambda run: lifecycle.record_checkpoint(run, 1, "runs/1", "0" * 64, True),
    "finish": lambda run: lifecycle.finish(run, 0, 1.0),
    "fail": lambda run: lifecycle.fail(run, "no"),
    "acknowledge cancel": lifecycle.acknowledge_cancel,
    "read the cancel flag": lifecycle.is_cancel_requested,
}


@pytest.mark.parametrize("write", WRITES.values(), ids=WRITES)
def test_a_worker_that_lost_its_lease_writes_nothing(split, write):
    ask(split)
    late = claim("cpu-1@here")
    expire(late)
    lifecycle.requeue_expired()
    claim("cpu-2@here")
    before = TrainingRun.objects.values().get()
    with pytest.raises(Fenced, match=r"\b1\b.*cpu-1@here"):
        write(late)
    assert TrainingRun.objects.values().get() == before
    assert not late.epochs.exists()
    assert not late.checkpoints.exists()
    assert late.events.filter(attempt=1, message="hello").count() == 0


@pytest.mark.parametrize("write", WRITES.values(), ids=WRITES)
def test_a_run_that_has_ended_is_written_by_nobody(split, write):
    ask(split)
    run = claim()
    lifecycle.finish(run, 0, 1.0)
    with pytest.raises(Fenced):
        write(run)


# --- what is recorded -----------------------------------------------------------------------------


def test_an_epoch_that_is_trained_again_replaces_its_row_and_all_later_ones(split):
    ask(split)
    run = claim()
    for epoch in (1, 2, 3):
        lifecycle.record_epoch(run, EpochReport(epoch, 1.0, None, None, 1.0))
    lifecycle.record_epoch(run, EpochReport(2, 0.5, None, None, 1.0))
    assert list(run.epochs.values_list("epoch", "train_loss")) == [(1, 1.0), (2, 0.5)]


def test_the_last_and_the_best_checkpoint_are_kept(split):
    ask(split)
    run = claim()
    forgotten = [
        lifecycle.record_checkpoint(run, epoch, f"e{epoch}", "0" * 64, epoch in (1, 3))
        for epoch in (1, 2, 3, 4, 5)
    ]
    assert forgotten == [[], [], ["e1", "e2"], [], ["e4"]]
    kept = Checkpoint.objects.values_list("folder", "is_best")
    assert list(kept) == [("e3", True), ("e5", False)]


def test_progress_stays_between_nothing_and_everything(split):
    ask(split)
    run = claim()
    lifecycle.record_progress(run, 1.7, "x" * 500)
    run.refresh_from_db()
    assert (run.progress, len(run.activity)) == (1.0, 200)


# --- cancelling -----------------------------------------------------------------------------------


def test_a_queued_run_is_cancelled_at_once(split):
    run = ask(split)
    lifecycle.cancel(run)
    run.refresh_from_db()
    assert run.status == "cancelled"
    assert run.finished_at is not None
    assert lifecycle.claim("cpu-1@here", "quick") is None


def test_a_running_run_is_asked_to_stop(split):
    ask(split)
    run = claim()
    lifecycle.cancel(run)
    assert lifecycle.is_cancel_requested(run)
    lifecycle.acknowledge_cancel(run)
    run.refresh_from_db()
    assert run.status == "cancelled"


def test_a_run_whose_worker_is_gone_is_cancelled_at_once(split):
    ask(split)
    run = claim()
    expire(run)
    lifecycle.cancel(run)
    run.refresh_from_db()
    assert run.status == "cancelled"


def test_a_run_that_has_ended_cannot_be_cancelled(split):
    ask(split)
    run = claim()
    lifecycle.finish(run, 0, 1.0)
    with pytest.raises(Refusal, match=rf"\b{run.pk}\b.*succeeded") as refused:
        lifecycle.cancel(run)
    assert refused.value.code == "already_ended"


def test_a_run_that_was_to_be_cancelled_is_not_resumed(split):
    ask(split)
    run = claim()
    lifecycle.cancel(run)
    expire(run)
    lifecycle.requeue_expired()
    run.refresh_from_db()
    assert run.status == "cancelled"


# --- losing workers -------------------------------------------------------------------------------


def test_a_run_is_resumed_twice_and_lost_the_third_time(split):
    run = ask(split)
    for resumes in (1, 2):
        expire(claim())
        assert lifecycle.requeue_expired() == [run]
        run.refresh_from_db()
        assert (run.status, run.resumes) == ("queued", resumes)
    expire(claim())
    lifecycle.requeue_expired()
    run.refresh_from_db()
    assert run.status == "lost"
    assert run.failure


def test_a_living_worker_keeps_its_run(split):
    ask(split)
    claim()
    assert lifecycle.requeue_expired() == []


def test_a_service_that_stops_hands_back_its_own_runs_and_loses_no_resumption(split):
    ask(split, seed=1)
    ask(split, seed=2)
    mine, others = claim("cpu-1@here"), claim("cpu-2@here")
    assert lifecycle.hand_back("cpu-1@here") == [mine]
    mine.refresh_from_db()
    others.refresh_from_db()
    assert (mine.status, mine.resumes, mine.worker) == ("queued", 0, "")
    assert others.status == "running"


def test_only_an_idle_worker_wakes_the_others_for_runs_that_were_forgotten(split):
    ask(split, seed=1)
    ask(split, seed=2)
    assert wake_for_forgotten("cpu-1@here", ["quick"]) == 0
    TrainingRun.objects.update(queued_at=timezone.now() - timedelta(minutes=1))
    assert wake_for_forgotten("cpu-1@here", ["gpu"]) == 0
    assert wake_for_forgotten("cpu-1@here", ["quick"]) == 2
    claim("cpu-1@here")
    assert wake_for_forgotten("cpu-1@here", ["quick"]) == 0
    assert wake_for_forgotten("cpu-2@here", ["quick"]) == 1
