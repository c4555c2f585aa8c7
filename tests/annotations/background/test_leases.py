"""A lease tells work that was taken away from work that its own block has ended."""

from __future__ import annotations

import time

import pytest

from annotations import background
from annotations.background import leasing
from parser_service.models import TrainingRun
from tests.parser_service.made_up import make_split
from tests.parser_service.requests import ask, claim
from tests.waiting import PATIENCE_SECONDS


@pytest.fixture
def run(world, transactional_db, monkeypatch) -> TrainingRun:
    monkeypatch.setattr(leasing, "LISTEN_EVERY", 0.01)
    ask(make_split(world), send=False)
    return claim()


def is_stopped(lease: background.Lease, seconds: float = 0.4) -> bool:
    """Tell whether the lease asks the work to stop in so many seconds; it looks at the row each 0.01."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        time.sleep(0.02)
        try:
            lease.check()
        except background.Stopped:
            return True
    return False


@pytest.mark.parametrize(
    ("end", "status"),
    [
        (background.finish, "succeeded"),
        (lambda run: background.fail(run, "It is too large."), "failed"),
        (background.acknowledge_cancel, "cancelled"),
    ],
)
def test_a_block_that_has_ended_its_work_may_go_on(run, caplog, end, status):
    stopped = []

    def do(lease: background.Lease) -> None:
        end(run)
        stopped.append(is_stopped(lease))

    background.while_held(run, do)
    run.refresh_from_db()
    assert run.status == status
    assert stopped == [False]
    assert not caplog.messages


def test_work_that_was_taken_away_stops_and_the_log_says_so(run, caplog):
    stopped = []

    def do(lease: background.Lease) -> None:
        background.hand_back(run.worker, TrainingRun)
        stopped.append(is_stopped(lease, PATIENCE_SECONDS))

    background.while_held(run, do)
    run.refresh_from_db()
    assert run.status == "queued"
    assert stopped == [True]
    assert caplog.messages == [f"Run {run.pk} no longer belongs to attempt 1 of cpu-1@here."]
