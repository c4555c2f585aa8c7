"""A split to train on, and workers that are gone when the test is over."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from django.conf import settings

from annotations.background import message_queue, queue_app
from annotations.models import Split
from annotations.models.background import Queue
from tests.parser_service.made_up import make_split
from tests.parser_service.worker_process import RunningWorker


@pytest.fixture
def split(world) -> Split:
    return make_split(world)


@pytest.fixture(scope="session", autouse=True)
def tidy_broker() -> Iterator[None]:
    """The broker of TEST_BROKER_URL is left without our queues."""
    yield
    if not settings.CELERY_BROKER_URL.startswith("filesystem:"):
        with queue_app().connection_for_write() as connection, connection.channel() as channel:
            for queue in Queue.values:
                channel.queue_delete(message_queue(queue))


@pytest.fixture
def start_worker(transactional_db, tmp_path) -> Iterator[Callable[..., RunningWorker]]:
    """Starts workers; whatever is left of them is killed in the end."""
    workers: list[RunningWorker] = []

    def start(*queues: str, **options: float) -> RunningWorker:
        log = tmp_path / f"worker-{len(workers)}.log"
        workers.append(RunningWorker(log, *queues, **options))
        return workers[-1]

    yield start
    for worker in workers:
        worker.remove()
        print(worker.log.read_text(encoding="utf-8"))
