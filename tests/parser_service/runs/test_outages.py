"""A worker whose database is cut off or locked while it trains."""

from __future__ import annotations

import sqlite3
import time

import pytest
from django.db import connection

from annotations.background import LEASE
from parser_service.runs import run_requests
from tests.parser_service.made_up import LONG
from tests.parser_service.proxy import Proxy
from tests.parser_service.worker_process import wait_for_epochs
from tests.waiting import wait_for

# Slower than in other tests: a worker that a busy machine holds up for seconds must not lose its lease.
TEMPO = 4.0
pytestmark = [pytest.mark.processes, pytest.mark.django_db(transaction=True)]
is_file = connection.vendor == "sqlite"
can_be_cut_off = pytest.mark.skipif(is_file, reason="a file cannot be cut off")
can_be_locked = pytest.mark.skipif(not is_file, reason="only SQLite locks everybody out")


@pytest.fixture
def proxy(transactional_db):
    given = connection.settings_dict
    proxy = Proxy(given["HOST"] or "127.0.0.1", int(given["PORT"] or 5432))
    yield proxy
    proxy.close()


@can_be_cut_off
def test_short_outages_cost_no_attempt(world, split, start_worker, proxy):
    start_worker(database_port=proxy.port, tempo=TEMPO)
    run, _ = run_requests.request(world, split, "seq2seq", LONG)
    for epoch in (2, 4, 6):
        wait_for_epochs(run, epoch)
        proxy.cut(1.5)
    seen = run.checkpoints.order_by("epoch").last().epoch
    wait_for_epochs(run, seen + 2)
    run.refresh_from_db()
    assert (run.status, run.attempt, run.resumes, run.failure) == ("running", 1, 0, "")


@can_be_cut_off
def test_a_long_outage_hands_the_run_back_and_says_how_long_it_was(
    world, split, start_worker, proxy
):
    start_worker(database_port=proxy.port, tempo=TEMPO)
    run, _ = run_requests.request(world, split, "seq2seq", LONG)
    wait_for_epochs(run, 2)
    proxy.cut(LEASE.total_seconds() / TEMPO + 3)
    away = run.events.filter(message__startswith="The database was away for")
    wait_for(away.exists, "the run is handed back")
    assert "checkpoint" in away.get().message
    wait_for(run.events.filter(attempt=2).exists, "the run goes on")
    run.refresh_from_db()
    assert (run.status, run.resumes) == ("running", 0)


@can_be_locked
def test_a_writer_that_locks_everybody_out_for_longer_than_a_lease_costs_no_attempt(
    world, split, start_worker
):
    start_worker(tempo=TEMPO)
    run, _ = run_requests.request(world, split, "seq2seq", LONG)
    wait_for_epochs(run, 2)
    other = sqlite3.connect(connection.settings_dict["NAME"], isolation_level=None, timeout=10)
    other.execute("BEGIN IMMEDIATE")
    time.sleep(LEASE.total_seconds() / TEMPO + 2)
    other.rollback()
    other.close()
    seen = run.checkpoints.order_by("epoch").last().epoch
    wait_for_epochs(run, seen + 5)
    run.refresh_from_db()
    assert (run.status, run.attempt, run.resumes) == ("running", 1, 0)
