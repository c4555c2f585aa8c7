"""Several people at the same moment: threads with a connection each, on the database of the test."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from django.db import connections

from tests.waiting import PATIENCE_SECONDS


def at_once(*actions: Callable[[], Any]) -> list[Any]:
    """Run the actions at the same time and return what they return, in their order."""
    results: list[Any] = [None] * len(actions)
    start = threading.Barrier(len(actions))

    def run(number: int, action: Callable[[], Any]) -> None:
        start.wait()
        try:
            results[number] = action()
        finally:
            connections.close_all()

    threads = [
        threading.Thread(target=run, args=(number, action)) for number, action in enumerate(actions)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE_SECONDS)
    return results
