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
