"""How much work Python code does: a number that is the same on a busy machine and on an idle one."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType


def steps_of(action: Callable[[], object]) -> int:
    """Run ``action`` and return how many lines of Python it ran in this thread, each round of a loop
    counted. What runs inside a function written in C counts as nothing."""
    steps = 0

    def count(frame: FrameType, event: str, argument: object):
        nonlocal steps
        if event == "line":
            steps += 1
        return count

    before = sys.gettrace()
    sys.settrace(count)
    try:
        action()
    finally:
        sys.settrace(before)
    return steps


def growth(action: Callable[[int], Callable[[], object]], size: int) -> float:
    """Return how many times as many steps ``action(2 * size)`` takes as ``action(size)``.

    What ``action`` does before it returns the action to measure is not counted. Linear work grows
    by 2, and work on each pair of things by 4.
    """
    return steps_of(action(2 * size)) / steps_of(action(size))
