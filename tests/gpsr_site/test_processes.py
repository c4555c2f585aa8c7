"""What happens to a child process that ends."""

from __future__ import annotations

import signal
import sys
import threading
from contextlib import contextmanager

import pytest

from gpsr_site import processes
from gpsr_site.processes import Supervisor
from tests.waiting import wait_for

IDLER = [sys.executable, "-c", "import time; time.sleep(600)"]


@contextmanager
def watched(made):
    """Start and watch processes that do nothing; signals are left as they were."""
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = {number: signal.getsignal(number) for number in numbers}
    made.start()
    watching = threading.Thread(target=made.watch)
    watching.start()
    yield made
    made.is_stopping = True
    watching.join()
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture
def supervisor():
    with watched(Supervisor({"idler": IDLER}, lambda sentence: None)) as made:
        yield made


@pytest.mark.processes
def test_a_child_that_is_killed_after_a_while_is_back_without_a_pause(supervisor, monkeypatch):
    monkeypatch.setattr(processes, "SETTLED_SECONDS", 0.0)
    monkeypatch.setattr(processes, "RESTART_PAUSE_SECONDS", 1e9)
    killed = supervisor.children["idler"]
    killed.kill()
    wait_for(lambda: supervisor.children["idler"].pid != killed.pid, "another one is there")


@pytest.mark.processes
def test_a_child_that_ends_at_once_is_not_started_over_and_over(supervisor, monkeypatch):
    monkeypatch.setattr(processes, "SETTLED_SECONDS", 1e9)
    monkeypatch.setattr(processes, "RESTART_PAUSE_SECONDS", 1e9)
    supervisor.children["idler"].kill()
    wait_for(lambda: "idler" in supervisor.restart_at, "it waits")
    assert supervisor.children["idler"].poll() is not None


@pytest.mark.processes
def test_what_is_for_later_is_started_when_it_is_time():
    is_time = threading.Event()
    later = {"later": IDLER}
    with watched(Supervisor({"first": IDLER}, print, later, is_time.is_set)) as made:
        assert list(made.children) == ["first"]
        is_time.set()
        wait_for(lambda: list(made.children) == ["first", "later"], "it is started")
