"""Interrupt a request that takes too long, and answer 503."""

from __future__ import annotations

import ctypes
import logging
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from django.conf import settings
from django.db import connections
from django.http import HttpRequest, HttpResponse, StreamingHttpResponse

from annotations.people.allowances import allowance_at
from annotations.web.rest.streaming import BrokenOff
from gpsr_site.web.refusals import refuse

logger = logging.getLogger(__name__)

LONG_FACTOR = 10  # for views that may take long
CHECK_SECONDS = 0.5
# What cleans up after an interruption may hang as well, as a rollback does with the database.
AGAIN_SECONDS = 5


class TookTooLong(BaseException):
    """Raised inside the thread of a request that is over its time.

    Not an ``Exception``, so that no handler on the way catches it.
    """


class TakenBack(BaseException):
    """Raised in the place of an interruption that has not arrived yet."""


@dataclass(slots=True)
class WatchedRequest:
    """A request at work: its thread, when it is interrupted next, and whether it ever was."""

    thread: int
    interrupted_at: float
    is_interrupted: bool = False


class Watchdog:
    """Interrupts threads whose request is over its time. One for a process.

    The interruption reaches Python code at its next step, and the wait for an answer of PostgreSQL
    within a tenth of a second (``PSYCOPG_WAIT_FUNC`` in the settings).
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._watched: dict[int, WatchedRequest] = {}
        self._is_running = False

    def begin(self, seconds: float) -> WatchedRequest:
        """Start the time of the request that this thread works on."""
        watched = WatchedRequest(threading.get_ident(), time.monotonic() + seconds)
        with self._lock:
            self._watched[id(watched)] = watched
            if not self._is_running:
                self._is_running = True
                threading.Thread(target=self._run, name="deadlines", daemon=True).start()
        return watched

    def end(self, watched: WatchedRequest) -> None:
        """Stop watching; an interruption that has not arrived yet is taken back."""
        try:
            self._forget(watched)
        except TookTooLong:  # it has arrived here, perhaps before anything was forgotten
            self._forget(watched)

    def _forget(self, watched: WatchedRequest) -> None:
        with self._lock:
            self._watched.pop(id(watched), None)
            if watched.is_interrupted:
                _take_back(watched.thread)

    def _run(self) -> None:
        while True:
            time.sleep(CHECK_SECONDS)
            with self._lock:
                now = time.monotonic()
                for watched in self._watched.values():
                    if now >= watched.interrupted_at:
                        watched.is_interrupted = True
                        watched.interrupted_at = now + AGAIN_SECONDS
                        _raise_in(watched.thread, TookTooLong)


def _raise_in(thread: int, exception: type[BaseException]) -> None:
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), ctypes.py_object(exception))


def _take_back(thread: int) -> None:
    """Undo an interruption of this thread.

    Clearing it would leave Python 3.11 looking for one at every step from then on, and stuck as soon
    as somebody traces.
    """
    try:
        _raise_in(thread, TakenBack)
        while True:
            pass
    except TakenBack:
        return


WATCHDOG = Watchdog()


class Deadline:
    """Middleware, outermost of all: bound the time that a request may take."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        seconds = settings.REQUEST_SECONDS
        if allowance_at(request.path_info).may_take_long:
            seconds *= LONG_FACTOR
        began = time.monotonic()
        try:
            watched = WATCHDOG.begin(seconds)
            try:
                response = self.get_response(request)
            finally:
                WATCHDOG.end(watched)
        except TookTooLong:
            connections.close_all()  # one of them may be in the middle of an answer
            logger.error("%s %s took over %s s, interrupted", request.method, request.path, seconds)
            return refuse(
                request,
                503,
                "This took too long",
                f"The server stopped working on it after {seconds:g} seconds, and nothing of it was "
                "saved. Ask for less at once, or try again later.",
                "took_too_long",
            )
        if isinstance(response, StreamingHttpResponse) and not hasattr(response, "file_to_stream"):
            left = seconds - (time.monotonic() - began)
            response.streaming_content = _bound(iter(response.streaming_content), left)
        return response


def _bound(pieces: Iterator[bytes], seconds: float) -> Iterator[bytes]:
    """Yield the pieces of an answer. Raises BrokenOff once making them has taken ``seconds``.

    The time that a client takes to read them does not count; the web server bounds that.
    """
    left = seconds
    while left > 0:
        began = time.monotonic()
        watched = WATCHDOG.begin(left)
        try:
            piece = next(pieces, None)
        except TookTooLong:
            connections.close_all()
            break
        finally:
            WATCHDOG.end(watched)
        if piece is None:
            return
        left -= time.monotonic() - began
        yield piece
    raise BrokenOff(f"making it took over {seconds:.0f} s")
