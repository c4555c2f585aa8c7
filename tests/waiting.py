"""Waiting for what other processes and threads do."""

from __future__ import annotations

import time
from collections.abc import Callable

import pytest

# For a machine that is busy with other things. What never happens fails after this.
PATIENCE_SECONDS = 120
LOOK_EVERY = 0.02


def wait_for(condition: Callable[[], object], what: str) -> None:
    """Return as soon as ``condition`` holds. Fails the test, saying ``what``, if it never does."""
    began = time.monotonic()
    while not condition():
        if time.monotonic() - began > PATIENCE_SECONDS:
            pytest.fail(f"{what}: not within {PATIENCE_SECONDS} seconds")
        time.sleep(LOOK_EVERY)
