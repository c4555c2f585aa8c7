"""A split to train on, and workers that are gone when the test is over."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator

import pytest

from annotations.models import Split
from tests.parser_service.made_up import make_split
from tests.parser_service.running import RunningWorker


@pytest.fixture
def split(world) -> Split:
    return make_split(world)


@pytest.fixture
def broker() -> str:
    """The filesystem broker, or the one of TEST_BROKER_URL."""
    return os.environ.get("TEST_BROKER_URL", "filesystem://localhost")


@pytest.fixture
def start_worker(transactional_db, broker, tmp_path) -> Iterator[Callable[[], RunningWorker]]:
    """Starts workers; whatever is left of them is killed in the end."""
    workers: list[RunningWorker] = []

    def start() -> RunningWorker:
        workers.append(RunningWorker(broker, tmp_path / f"worker-{len(workers)}.log"))
        return workers[-1]

    yield start
    for worker in workers:
        worker.remove()
        print(worker.log.read_text(encoding="utf-8"))
