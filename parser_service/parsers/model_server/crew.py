"""Threads that wait for a server, while the thread that started them looks whether to stop."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

from parser_service.parsers.interface import Check
from parser_service.parsers.model_server.exchange import Abandoned, Exchange, Reply
from parser_service.parsers.server_address import ModelServer

LOOK_EVERY = 0.1  # seconds between two looks at whether to stop
T = TypeVar("T")


class Crew(Generic[T]):
    """Carries out jobs, at most ``at_once`` at a time, and calls ``check`` every ``LOOK_EVERY`` seconds.

    What ``check`` or a job raises ends all of them within moments: exchanges are broken off, pauses end.
    """

    def __init__(self, server: ModelServer, at_once: int, check: Check) -> None:
        self._server = server
        self._at_once = at_once
        self._check = check
        self._lock = threading.Lock()
        self._progress = threading.Event()  # something ended
        self._stopping = threading.Event()
        self._exchanges: set[Exchange] = set()
        self._results: dict[int, T] = {}
        self._error: Exception | None = None

    def run(self, jobs: Sequence[Callable[[Crew[T]], T]]) -> list[T]:
        """Return what each job returns. Raises the first error of a job, or what ``check`` raises."""
        waiting = iter(enumerate(jobs))
        for _ in range(min(self._at_once, len(jobs))):
            # A daemon: a process that ends does not wait for what a server may never answer.
            threading.Thread(target=self._work, args=[waiting], daemon=True).start()
        try:
            while len(self._results) < len(jobs):
                self._progress.wait(LOOK_EVERY)
                self._progress.clear()
                self._check()
                if self._error is not None:
                    raise self._error
                for each in self._open():
                    each.look_at_the_clock()
        finally:
            self._stopping.set()
            for each in self._open():
                each.abandon()
        return [self._results[number] for number in range(len(jobs))]

    def send(self, method: str, path: str, body: bytes | None = None) -> Reply:
        """Send a request from the thread of a job. Raises as ``Exchange.send``."""
        exchange = Exchange(self._server, self._server.patience.answer)
        with self._lock:
            if self._stopping.is_set():
                raise Abandoned
            self._exchanges.add(exchange)
        try:
            return exchange.send(method, path, body)
        finally:
            with self._lock:
                self._exchanges.discard(exchange)

    def pause(self, seconds: float) -> None:
        """Wait in the thread of a job. Raises Abandoned where the work is to stop."""
        if self._stopping.wait(seconds):
            raise Abandoned

    def _open(self) -> list[Exchange]:
        with self._lock:
            return list(self._exchanges)

    def _work(self, waiting: enumerate[Callable[[Crew[T]], T]]) -> None:
        while not self._stopping.is_set():
            with self._lock:
                number, job = next(waiting, (None, None))
            if number is None or job is None:
                return
            try:
                self._results[number] = job(self)
            except Abandoned:
                return
            except Exception as error:
                self._error = self._error or error
                self._stopping.set()
            finally:
                self._progress.set()
