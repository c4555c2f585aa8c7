"""A database that is away, locked or full costs no work; what can never succeed is not tried again."""

from __future__ import annotations

import errno
import sqlite3
import threading
from collections.abc import Callable
from datetime import timedelta

import psycopg
import pytest
from django.db import InterfaceError, OperationalError, connection
from django.utils import timezone

from annotations import background
from annotations.background import LEASE, DatabaseAway, LeaseWatch, fencing, lease_watch, outages
from annotations.background.failures import is_disk_full
from annotations.background.outages import is_outage
from gpsr_site.celery import app
from parser_service.models import TrainingRun
from tests.parser_service.made_up import make_split
from tests.parser_service.requests import ask, claim


def caused_by(cause: Exception) -> OperationalError:
    error = OperationalError(str(cause))
    error.__cause__ = cause
    return error


def sqlite_error(code: int, message: str) -> OperationalError:
    cause = sqlite3.OperationalError(message)
    cause.sqlite_errorcode = code
    return caused_by(cause)


OUTAGES = {
    "closed": InterfaceError("the connection is closed"),
    "lost": OperationalError("server closed the connection unexpectedly"),
    "shut down": caused_by(psycopg.errors.AdminShutdown("terminating connection")),
    "deadlock": caused_by(psycopg.errors.DeadlockDetected("deadlock detected")),
    "locked": sqlite_error(sqlite3.SQLITE_BUSY, "database is locked"),
    "full": sqlite_error(sqlite3.SQLITE_FULL, "database or disk is full"),
}
FAULTS = {
    "no table": sqlite_error(sqlite3.SQLITE_ERROR, "no such table: x"),
    "too long": caused_by(psycopg.errors.QueryCanceled("statement timeout")),
    "ours": ValueError("no"),
}


@pytest.mark.parametrize("error", OUTAGES.values(), ids=OUTAGES)
def test_an_outage_is_known_in_every_form(error):
    assert is_outage(error)


@pytest.mark.parametrize("error", FAULTS.values(), ids=FAULTS)
def test_what_cannot_succeed_later_is_no_outage(error):
    assert not is_outage(error)


@pytest.fixture
def run(world, transactional_db) -> TrainingRun:
    ask(make_split(world), send=False)
    return claim()


@pytest.fixture
def fail_writes(monkeypatch) -> Callable[..., None]:
    """Lets the next writes fail with the given errors."""

    def fail(*errors: Exception) -> None:
        coming, write = list(errors), fencing.write

        def write_or_fail(*args, **values) -> None:
            if coming:
                raise coming.pop(0)
            write(*args, **values)

        monkeypatch.setattr(fencing, "write", write_or_fail)
        monkeypatch.setattr(outages, "TRY_EVERY", 0.01)

    return fail


def test_a_write_is_tried_again_until_the_database_is_back(run, fail_writes):
    fail_writes(*OUTAGES.values())
    background.record_progress(run, 0.5, "training")
    run.refresh_from_db()
    assert (run.progress, run.status) == (0.5, "running")


def test_a_fault_is_raised_at_once(run, fail_writes):
    fail_writes(FAULTS["no table"], FAULTS["no table"])
    with pytest.raises(OperationalError) as raised:
        background.record_progress(run, 0.5, "training")
    assert raised.value is FAULTS["no table"]


def hand_back_after(run: TrainingRun, error: Exception) -> str:
    """What the log of ``run`` says last, once its work has met ``error``."""

    def do(lease: background.Lease) -> None:
        raise error

    background.while_held(run, do)
    run.refresh_from_db()
    return run.events.last().message


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (OUTAGES["closed"], "The database was away for a moment"),
        (OUTAGES["locked"], "The database was locked by another writer for a moment"),
        (OUTAGES["full"], "The database's disk was full for a moment"),
    ],
)
def test_work_that_an_outage_stops_is_handed_back_with_the_reason(run, error, reason):
    said = hand_back_after(run, error)
    assert said == f"{reason}; resuming from the last checkpoint."
    assert (run.status, run.resumes, run.worker, run.failure) == ("queued", 0, "", "")


def test_an_outage_longer_than_the_lease_says_how_long_it_was(run, monkeypatch, fail_writes):
    monkeypatch.setattr(outages, "LEASE", timedelta(seconds=1))
    fail_writes(*[OUTAGES["lost"]] * 1000)
    monkeypatch.setattr(outages, "TRY_EVERY", 0.5)
    with pytest.raises(DatabaseAway) as raised:
        background.record_progress(run, 0.5, "training")
    said = hand_back_after(run, raised.value)
    assert said.startswith(("The database was away for 1 s", "The database was away for 2 s"))


def test_a_fault_of_the_database_fails_the_work(run, caplog):
    hand_back_after(run, FAULTS["no table"])
    assert run.status == "failed"
    assert "OperationalError" in run.failure
    assert "no such table" in caplog.text


@pytest.mark.skipif(connection.vendor != "sqlite", reason="only SQLite locks everybody out")
def test_a_locked_database_delays_a_write_and_no_more(run, monkeypatch):
    monkeypatch.setattr(outages, "TRY_EVERY", 0.05)
    other = sqlite3.connect(connection.settings_dict["NAME"], check_same_thread=False)
    other.isolation_level = None
    other.execute("BEGIN IMMEDIATE")
    with connection.cursor() as cursor:
        cursor.execute("PRAGMA busy_timeout = 10")
    threading.Timer(0.3, other.rollback).start()
    background.record_progress(run, 0.5, "training")
    run.refresh_from_db()
    assert run.progress == 0.5
    other.close()


# --- leases that only seem to have expired --------------------------------------------------------


@pytest.fixture
def clock(monkeypatch):
    """The database's clock and the timer's, which the test sets."""
    times = {"clock": timezone.now(), "monotonic": 1000.0}
    monkeypatch.setattr(lease_watch, "_database_clock", lambda: times["clock"])
    monkeypatch.setattr(lease_watch.time, "monotonic", lambda: times["monotonic"])

    def advance(seconds: float, step: float = 0.0) -> None:
        times["monotonic"] += seconds
        times["clock"] += timedelta(seconds=seconds + step)

    return advance


@pytest.mark.parametrize("step", [3600, -3600])
def test_after_a_step_of_the_clock_holders_can_extend_before_anything_is_taken(clock, step):
    watch = LeaseWatch()
    assert watch.is_trusted()
    clock(5)
    assert watch.is_trusted()
    clock(5, step)
    assert not watch.is_trusted()
    clock(15)
    assert not watch.is_trusted()
    clock(6)
    assert watch.is_trusted()


def test_a_timer_that_was_held_up_lets_holders_extend_before_anything_is_taken(clock):
    watch = LeaseWatch()
    assert watch.is_trusted()
    clock(60)
    assert not watch.is_trusted()


def test_after_an_outage_holders_can_extend_before_anything_is_taken(clock):
    watch = LeaseWatch()
    watch.distrust()
    assert not watch.is_trusted()
    clock(lease_watch.GRACE)
    assert watch.is_trusted()


def test_a_lease_from_before_the_clock_was_set_back_does_not_hold_for_ever(run):
    TrainingRun.objects.update(lease_until=timezone.now() + timedelta(hours=1))
    assert list(TrainingRun.objects.expired()) == [run]
    TrainingRun.objects.update(lease_until=timezone.now() + LEASE)
    assert not TrainingRun.objects.expired().exists()


# --- disks and brokers ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "error",
    [
        OSError(errno.ENOSPC, "No space left on device"),
        OSError(errno.EDQUOT, "Disk quota exceeded"),
        RuntimeError("I/O error: No space left on device (os error 28)"),
        OUTAGES["full"],
        caused_by(psycopg.errors.DiskFull("could not extend file")),
    ],
)
def test_a_full_disk_is_known_in_every_form(error):
    assert is_disk_full(error)


def test_a_worker_waits_for_its_broker_for_ever():
    assert app.conf.broker_connection_max_retries is None
    assert app.conf.broker_connection_retry_on_startup
