"""A worker that is killed or told to stop in the middle of a job: the world is as it was, or complete."""

from __future__ import annotations

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.background.job_files import folder_of
from annotations.background.requesting import cancel_job, request_job
from annotations.exchange.generator_import import import_generator
from annotations.models import Job, JobKind, Production
from tests.annotations.conftest import TINY, as_bytes
from tests.annotations.rows_of import rows_of
from tests.parser_service.worker_process import RunningWorker, wait_for_status
from tests.waiting import wait_for

pytestmark = [pytest.mark.processes, pytest.mark.django_db(transaction=True)]

LINES = 30_000


@pytest.fixture
def start_worker(tmp_path):
    """Starts workers for short work; all of them are gone after the test."""
    workers: list[RunningWorker] = []

    def start() -> RunningWorker:
        workers.append(RunningWorker(tmp_path / "worker.log", "quick"))
        return workers[-1]

    yield start
    for worker in workers:
        worker.remove()


@pytest.fixture
def large_import(world) -> Job:
    """An import that takes seconds, into a world that has something already."""
    import_generator(world.name, as_bytes(TINY))
    lines = "".join(f"$a = the thing number {number}\n" for number in range(LINES))
    text = f"$Main = find $a\n{lines}".encode()
    return request_job(
        JobKind.IMPORT_GENERATOR,
        world.name,
        None,
        {"is_confirmed": True},
        [SimpleUploadedFile("large.txt", text)],
    )


def wait_until_busy(job: Job) -> None:
    def is_reading() -> bool:
        job.refresh_from_db()
        return job.activity == "reading the files"

    wait_for(is_reading, "the job reads its files")


@pytest.mark.parametrize("how", ["kill_child", "kill_parent"])
def test_a_killed_import_leaves_the_world_as_it_was_and_is_done_by_the_next(
    world, large_import, start_worker, how
):
    before = rows_of(world)
    worker = start_worker()
    wait_until_busy(large_import)
    getattr(worker, how)()
    assert rows_of(world) == before
    if how == "kill_parent":
        start_worker()
    wait_for_status(large_import, "succeeded")
    assert large_import.attempt == 2
    assert Production.objects.filter(grammar__world=world).count() == LINES + 1
    wait_for(lambda: not folder_of(large_import).exists(), "the files are gone")


def test_a_cancelled_import_stops_and_leaves_the_world_as_it_was(world, large_import, start_worker):
    before = rows_of(world)
    start_worker()
    wait_until_busy(large_import)
    cancel_job(large_import)
    wait_for_status(large_import, "cancelled")
    assert rows_of(world) == before
