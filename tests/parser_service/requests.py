"""Asking for runs and claiming them in tests, one at a time or many at once."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from django.db import connections

from parser_service.models import TrainingRun
from parser_service.runs import lifecycle, run_requests


def ask(split, **changes) -> TrainingRun:
    return run_requests.request(split.world, split, changes.pop("parser", "knn"), **changes)[0]


def claim(name: str = "cpu-1@here", queue: str = "quick") -> TrainingRun:
    run = lifecycle.claim(name, queue)
    assert run is not None
    return run


def at_once(work: Callable[[int], Any], number: int = 6) -> list[Any]:
    """What ``work`` gives in threads of their own, each with its own connection."""

    def connected(name: int) -> Any:
        try:
            return work(name)
        finally:
            connections.close_all()

    with ThreadPoolExecutor(number) as pool:
        return list(pool.map(connected, range(number)))
