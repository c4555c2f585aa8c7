"""A worker that its broker refuses waits longer each time."""

from __future__ import annotations

from types import SimpleNamespace

from gpsr_site import consumer
from gpsr_site.consumer import LONGEST_WAIT, PatientConsumer


def test_a_refused_worker_waits_longer_each_time_and_begins_anew_after_a_while(monkeypatch):
    waits, clock = [], SimpleNamespace(now=1_000.0)

    def sleep(seconds: float) -> None:
        waits.append(seconds)
        clock.now += seconds

    monkeypatch.setattr(consumer, "time", SimpleNamespace(sleep=sleep, monotonic=lambda: clock.now))
    refused = PatientConsumer.__new__(PatientConsumer)
    for _ in range(7):
        refused.on_connection_error_before_connected(OSError("no such virtual host"))
    assert waits == [1, 2, 4, 8, 16, 32, LONGEST_WAIT]
    clock.now += 3 * LONGEST_WAIT
    refused.on_connection_error_before_connected(OSError("no such virtual host"))
    assert waits[-1] == 1
