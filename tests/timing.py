"""Times that tests compare: processor time, the least of several, so that a busy machine changes little."""

from __future__ import annotations

import time
from collections.abc import Callable


def least_seconds(work: Callable[[], object], times: int = 5) -> float:
    """Return the least seconds of processor time that ``work`` takes in so many ``times``."""
    return min(_seconds(work) for _ in range(times))


def _seconds(work: Callable[[], object]) -> float:
    began = time.process_time()
    work()
    return time.process_time() - began


ROUNDS, IDLE_SECONDS = 200_000, 0.004  # a loop of so many rounds, on an idle core


def idle_seconds(seconds: float) -> float:
    """Return what ``seconds`` of processor time just now would be on an idle core, by a loop of known work. Beside
    other work a core is shared and its caches are, and the same work takes two or three times as long."""
    return seconds * min(1.0, IDLE_SECONDS / least_seconds(_reference, times=3))


def _reference() -> None:
    for _ in range(ROUNDS):
        pass
