"""A request that takes too long is interrupted and answered; its thread serves others again."""

from __future__ import annotations

import threading
import time
from contextlib import contextmanager

import pytest
from django.http import HttpResponse
from django.test import RequestFactory

from annotations.web.rest.streaming import BrokenOff
from gpsr_site.web import deadlines
from gpsr_site.web.deadlines import Deadline, TookTooLong, Watchdog
from tests.waiting import PATIENCE_SECONDS
from tests.work import steps_of


def endless(request):
    while True:
        try:
            sum(range(1000))
        except Exception:
            pytest.fail("no handler of errors may swallow the interruption")


def interrupt_another():
    """Return once a request that began in another thread just now was interrupted."""
    answers = in_threads(1, lambda: Deadline(endless)(RequestFactory().get("/")))
    assert [answer.status_code for answer in answers] == [503]


def in_threads(count, action):
    results = []
    threads = [
        threading.Thread(target=lambda: results.append(action()), daemon=True) for _ in range(count)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE_SECONDS)
    return results


@pytest.fixture
def half_a_second(settings):
    settings.REQUEST_SECONDS = 0.5


def test_a_request_over_its_time_is_answered_503(half_a_second):
    answer = Deadline(endless)(RequestFactory().get("/w/home/grammar/coverage/"))
    assert answer.status_code == 503
    assert " 0.5 seconds" in answer.content.decode()


def test_the_thread_is_not_interrupted_again(half_a_second, monkeypatch):
    monkeypatch.setattr(deadlines, "AGAIN_SECONDS", 0)
    Deadline(endless)(RequestFactory().get("/"))
    interrupt_another()


def test_the_thread_can_be_traced_afterwards(half_a_second):
    Deadline(endless)(RequestFactory().get("/"))
    assert steps_of(lambda: None) == 1


def test_a_quick_request_is_left_alone():
    middleware = Deadline(lambda request: HttpResponse("ok"))
    assert middleware(RequestFactory().get("/")).content == b"ok"


def test_an_import_may_take_longer(half_a_second, monkeypatch):
    monkeypatch.setattr(deadlines, "LONG_FACTOR", 1000)

    def slow(request):
        interrupt_another()
        return HttpResponse("ok")

    assert Deadline(slow)(RequestFactory().post("/w/home/import/")).status_code == 200


def test_many_at_once_are_all_interrupted(half_a_second):
    answers = in_threads(8, lambda: Deadline(endless)(RequestFactory().get("/")))
    assert [answer.status_code for answer in answers] == [503] * 8


def test_no_handler_of_errors_takes_it_for_one_of_its_own():
    assert not issubclass(TookTooLong, Exception)


def test_an_interruption_that_arrives_when_the_request_ends_is_forgotten_with_it():
    watchdog = Watchdog()
    watched = watchdog.begin(PATIENCE_SECONDS)
    lock = watchdog._lock

    @contextmanager
    def interrupting():
        with lock:
            if not watched.is_interrupted:
                watched.is_interrupted = True
                deadlines._raise_in(watched.thread, TookTooLong)
            yield

    class Lock:
        def __enter__(self):
            self._held = interrupting()
            return self._held.__enter__()

        def __exit__(self, *error):
            return self._held.__exit__(*error)

    watchdog._lock = Lock()
    watchdog.end(watched)
    assert watchdog._watched == {}


def test_pieces_that_are_each_made_quickly_have_an_end_too():
    def pieces():
        for _ in range(4):
            time.sleep(0.03)
            yield b"."

    answered = []
    with pytest.raises(BrokenOff):
        answered.extend(deadlines._bound(pieces(), 0.05))
    assert len(answered) <= 2
