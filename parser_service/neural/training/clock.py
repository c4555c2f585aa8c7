"""Tells how many steps of a training there is time for."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager

LATEST = 32  # steps, which tell how long the next ones take
LEAST_TIMED = 4


class Clock:
    """Counts the seconds of a training from here. ``minutes`` is how many it may take; 0: as many as it takes.

    It goes by the processor's time on each of ``threads``: a machine that does something else as well lets a
    training wait, which is no reason to learn less. Whoever resumes a run that was stopped puts the seconds
    that it had spent into ``before``.
    """

    def __init__(self, minutes: float = 0.0, threads: int = 1):
        self.most = 60 * minutes or math.inf
        self.before = 0.0
        self._threads = threads
        self._steps: deque[float] = deque(maxlen=LATEST)
        self._began = self.now()

    def now(self) -> float:
        """Return seconds since some moment."""
        return time.process_time() / self._threads

    @property
    def spent(self) -> float:
        return self.before + self.now() - self._began

    @contextmanager
    def step(self) -> Iterator[None]:
        """Take the time of a step."""
        began = self.now()
        yield
        self._steps.append(self.now() - began)

    @property
    def a_step(self) -> float:
        """Return the seconds of a step, 0 where too few were timed."""
        timed = len(self._steps)
        return sum(self._steps) / timed if timed >= LEAST_TIMED else 0.0

    def steps_left(self, reserved: float) -> float:
        """Return for how many steps there is time, beside ``reserved`` seconds of other work; at least 1."""
        left = self.most - self.spent - reserved
        return max(1.0, left / self.a_step) if self.a_step else math.inf
