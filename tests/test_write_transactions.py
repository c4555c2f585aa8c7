"""The measure of write transactions, by which every test fails that computes in one, measures."""

from __future__ import annotations

import gc
import time
from dataclasses import replace

import pytest
from django.db import connection, transaction

from annotations import background
from annotations.background.carrying_out_jobs import carry_out
from annotations.background.requesting import request_job
from annotations.labelling.collecting import collect
from annotations.models import Job, JobKind
from tests.write_transactions import ROOT, WHOLE, measured_transactions

pytestmark = pytest.mark.django_db


def spin(seconds: float) -> None:
    until = time.thread_time() + seconds
    while time.thread_time() < until:
        pass


def test_a_transaction_of_ours_is_measured_and_named(world):
    with measured_transactions(longer_than=0) as lasted:
        collect(world, ["go home"])
    places = [each.place for each in lasted]
    assert "annotations/labelling/collecting.py:_store" in places
    assert not any(each.is_in_job or each.is_too_long for each in lasted)


def test_a_job_may_keep_others_from_writing_for_a_shorter_time(world):
    job = request_job(JobKind.PROPOSE, "home", None)
    with measured_transactions(longer_than=0) as lasted:
        carry_out(background.claim("a worker", "quick", Job, job))
    (ended,) = [
        each for each in lasted if each.place == "annotations/background/carrying_out_jobs.py:_do"
    ]
    assert ended.is_in_job
    assert replace(ended, seconds=0.3).is_too_long
    assert not replace(ended, seconds=0.3, is_in_job=False).is_too_long


def test_what_a_transaction_of_a_test_does_is_its_own_business():
    with measured_transactions(longer_than=0.01) as lasted, transaction.atomic():
        spin(0.02)
    assert lasted == []


def test_collecting_garbage_is_not_what_a_transaction_does(world):
    heap = [[] for _ in range(1_000_000)]
    begun = time.thread_time()
    gc.collect()
    once = time.thread_time() - begun

    def collect_garbage(execute, *statement):
        gc.collect()
        return execute(*statement)

    with (
        measured_transactions(longer_than=0) as lasted,
        connection.execute_wrapper(collect_garbage),
    ):
        collect(world, ["go home"])
    assert heap
    (stored,) = [
        each for each in lasted if each.place == "annotations/labelling/collecting.py:_store"
    ]
    assert stored.seconds < once


def test_exceptions_are_functions_that_are_there():
    for place in WHOLE:
        path, _, function = place.partition(":")
        assert f"def {function}(" in (ROOT / path).read_text()
