"""A broker ends no worker for a message that it holds: a worker holds none while it works."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from pathlib import Path

import pytest
from kombu import Connection
from kombu.exceptions import KombuError

from annotations.background import TASK, message_queue, queue_app
from parser_service.models import Worker
from parser_service.runs import lifecycle, run_requests
from tests.durability.site import free_port
from tests.parser_service.made_up import LONG, TINY
from tests.parser_service.worker_process import wait_for_epochs, wait_for_status
from tests.waiting import wait_for

SERVER = Path("/usr/lib/rabbitmq/bin/rabbitmq-server")
HELD_MOST_MS, LOOK_EVERY_MS = 3000, 500  # as shipped: half an hour, and every minute

pytestmark = [
    pytest.mark.processes,
    pytest.mark.services,
    pytest.mark.django_db(transaction=True),
]


@pytest.fixture(scope="module")
def impatient_broker(tmp_path_factory) -> Iterator[str]:
    """The address of a RabbitMQ of this test's own, which ends whoever holds a message for three seconds.

    RabbitMQ before 3.12 knows one such time for all its queues, so that of others cannot be used.
    """
    if not SERVER.exists() or not os.environ.get("TEST_BROKER_URL", "").startswith("amqp"):
        pytest.skip("needs RabbitMQ (TEST_BROKER_URL) and its server on this machine")
    folder, port = tmp_path_factory.mktemp("rabbitmq"), free_port()
    (folder / "rabbitmq.conf").write_text(
        f"listeners.tcp.1 = 127.0.0.1:{port}\nconsumer_timeout = {HELD_MOST_MS}\n"
    )
    (folder / "advanced.config").write_text(
        f"[{{rabbit, [{{channel_tick_interval, {LOOK_EVERY_MS}}}]}}].\n"
    )
    environment = {
        "PATH": os.environ["PATH"],
        "HOME": str(folder),
        "RABBITMQ_NODENAME": f"test-{port}@localhost",
        "RABBITMQ_DIST_PORT": str(free_port()),
        "RABBITMQ_CONFIG_FILE": str(folder / "rabbitmq"),
        "RABBITMQ_ADVANCED_CONFIG_FILE": str(folder / "advanced.config"),
        "RABBITMQ_MNESIA_BASE": str(folder / "mnesia"),
        "RABBITMQ_LOG_BASE": str(folder / "log"),
        "RABBITMQ_ENABLED_PLUGINS_FILE": str(folder / "plugins"),
    }
    with ExitStack() as stack:
        log = stack.enter_context((folder / "out").open("wb"))
        server = subprocess.Popen([SERVER], env=environment, stdout=log, stderr=log)
        stack.callback(server.wait, 60)
        stack.callback(server.terminate)
        address = f"amqp://guest:guest@127.0.0.1:{port}//"

        def answers() -> bool:
            assert server.poll() is None, (folder / "out").read_text()
            with suppress(OSError, KombuError), Connection(address) as connection:
                connection.connect()
                return True
            return False

        wait_for(answers, "RabbitMQ answers")
        yield address


def test_workers_outlive_what_a_broker_lets_them_hold(
    world, split, impatient_broker, start_worker, monkeypatch
):
    monkeypatch.setenv("CELERY_BROKER_URL", impatient_broker)
    workers = [start_worker("cpu"), start_worker("cpu")]
    wait_for(lambda: len(Worker.objects.alive()) == 2, "two workers show themselves")
    long = [run_requests.request(world, split, "seq2seq", LONG, seed=seed)[0] for seed in (1, 2)]
    for run in long:
        wait_for_epochs(run, 1)
    short = [
        run_requests.request(world, split, "seq2seq", {**TINY, "epochs": 1}, seed=seed)[0]
        for seed in (3, 4, 5)
    ]
    with Connection(impatient_broker) as connection:
        for _ in short:
            _ring(connection, "cpu")
        time.sleep(3 * (HELD_MOST_MS + LOOK_EVERY_MS) / 1000)
        assert _waiting(connection, "cpu") >= len(short)
    assert [worker.process.poll() for worker in workers] == [None, None]
    for run in long:
        lifecycle.cancel(run)
    for run in short:
        wait_for_status(run, "succeeded")
    for run in (*short, *long):
        run.refresh_from_db()
        assert (run.attempt, run.resumes) == (1, 0)
    logs = "".join(worker.log.read_text() for worker in workers)
    assert "PRECONDITION_FAILED" not in logs
    assert "Traceback" not in logs


def _ring(connection: Connection, queue: str) -> None:
    """Send a message to a worker through ``connection``; the test's own process has another broker."""
    queue_app().send_task(TASK, args=[queue], queue=message_queue(queue), connection=connection)


def _waiting(connection: Connection, queue: str) -> int:
    """Return how many messages of a queue no worker has taken."""
    with connection.channel() as channel:
        return channel.queue_declare(message_queue(queue), passive=True).message_count
