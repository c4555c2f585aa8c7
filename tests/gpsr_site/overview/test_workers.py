"""What the banner and the top bar say of the workers that are there and that are missing."""

from __future__ import annotations

import pytest
from django.utils import timezone

from annotations.models.background import Queue
from gpsr_site.overview.workers import TAKEN_BY, workers_now
from parser_service.models import TrainingRun, Worker
from parser_service.runs import run_requests


def alive(*queues: str) -> None:
    Worker.objects.create(
        name="-".join(queues),
        host="h",
        process_id=1,
        queue=",".join(queues),
        last_seen=timezone.now(),
    )


@pytest.mark.parametrize("served", [["cpu", "gpu", "quick"], ["cpu", "quick"]])
def test_one_worker_may_serve_all_queues(db, served):
    alive(*served)
    workers = workers_now()
    assert (workers.is_alive, workers.headline, workers.sentence) == (True, "", "")
    assert (workers.running, sum(workers.waiting.values())) == (0, 0)


def test_each_queue_needs_a_worker(sample):
    alive("quick")
    run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    run_requests.request(sample.world, sample.split, "knn", seed=7, send=False)
    workers = workers_now()
    assert workers.missing == ["cpu"] and TAKEN_BY[Queue.CPU] in workers.headline
    assert workers.sentence.startswith("1 run ")
    assert TAKEN_BY[Queue.CPU] in workers.summary and "2 " in workers.summary


def test_a_gpu_worker_is_missed_only_where_work_waits_for_one(sample):
    alive("cpu", "quick")
    run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    assert workers_now().is_alive
    TrainingRun.objects.filter(status="queued").update(queue="gpu")
    assert workers_now().missing == ["gpu"]
    assert TAKEN_BY[Queue.GPU] in workers_now().headline


def test_of_several_missing_workers_the_one_is_named_that_work_waits_for(sample):
    alive("gpu")
    run_requests.request(sample.world, sample.split, "knn", seed=7, send=False)
    workers = workers_now()
    assert workers.missing == ["cpu", "quick"]
    assert TAKEN_BY[Queue.QUICK] in workers.headline
    assert workers.is_work_left


def test_work_that_a_living_worker_takes_is_not_left_where_another_worker_is_missing(sample):
    alive("quick")
    run_requests.request(sample.world, sample.split, "knn", seed=7, send=False)
    assert not workers_now().is_work_left
    run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    assert workers_now().is_work_left


def test_what_a_stopped_worker_left_behind_waits_too(sample):
    run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    run_requests.request(sample.world, sample.split, "knn", seed=7, send=False)
    TrainingRun.objects.filter(status="queued", parser="knn").update(status="running")
    workers = workers_now()
    assert (workers.running, sum(workers.waiting.values())) == (1, 1)
    assert "2 " in workers.summary and workers.sentence.startswith("2 runs ")
