"""Which requests may have how many threads of a web process, so that slow ones stop nobody else.

Writers wait for each other (SQLite has one at a time), batches and downloads compute for long. They share
some of the threads, and wait for one of these without taking any other. Some are left for pages, and the
last one for ``/healthz``. What has waited too long is answered 503, with the time to try again.
"""

from __future__ import annotations

import logging
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

from django.http import HttpRequest, HttpResponse
from rest_framework.permissions import SAFE_METHODS
from waitress.channel import HTTPChannel
from waitress.parser import HTTPRequestParser
from waitress.task import ThreadedTaskDispatcher, WSGITask

from annotations.people.allowances import allowance_at
from annotations.web.rest.streaming import JSON_LINES_TYPES, BrokenOff
from gpsr_site.web.refusals import refuse

logger = logging.getLogger(__name__)

THREADS = 8
FOR_HEALTH = 1
FOR_READING = 2
LOOK_SECONDS = 0.5  # between two looks at who has waited too long
REFUSED = "gpsr.refused"  # in the environment of a request: what it asks of its thread
# REST takes them by other spellings too, such as */JSONL.
LINES = tuple(each.partition("/")[2] for each in JSON_LINES_TYPES)


class RequestKind(Enum):
    """What a request asks of its thread."""

    HEALTH = "health"
    READ = "read"
    WRITE = "write"
    LONG = "long"
    BATCH = "batch"


@dataclass(frozen=True, slots=True)
class ThreadShare:
    """At most ``threads`` at once. Whoever waits for longer than ``patience`` seconds is refused, and told to try
    again after ``retry_after`` seconds."""

    threads: int
    patience: float
    retry_after: int = 5


ALL_BUT_HEALTH = THREADS - FOR_HEALTH
SLOW = ALL_BUT_HEALTH - FOR_READING  # writers, downloads and batches together
SHARES = {
    RequestKind.HEALTH: ThreadShare(THREADS, patience=60),
    RequestKind.READ: ThreadShare(ALL_BUT_HEALTH, patience=30),
    RequestKind.WRITE: ThreadShare(SLOW, patience=10),
    RequestKind.LONG: ThreadShare(3, patience=30, retry_after=30),
    RequestKind.BATCH: ThreadShare(2, patience=0, retry_after=10),
}
WHY = {
    RequestKind.HEALTH: "The server is busy.",
    RequestKind.READ: "Too many people ask for pages at once.",
    RequestKind.WRITE: "Others are writing, and your change has waited too long. Nothing of it was saved.",
    RequestKind.LONG: "Others make or download large files.",
    RequestKind.BATCH: "Others have batches parsed. A batch can also be given to a worker: POST it to parse/jobs/.",
}


def kind_of(method: str, path: str, content_type: str = "") -> RequestKind:
    """Return what a request asks of its thread, as the view at its address says."""
    if path == "/healthz":
        return RequestKind.HEALTH
    allowance = allowance_at(path)
    if method in SAFE_METHODS:
        return RequestKind.LONG if allowance.may_take_long else RequestKind.READ
    if not allowance.only_reads:
        return RequestKind.WRITE
    sent = content_type.lower()
    return RequestKind.BATCH if any(each in sent for each in LINES) else RequestKind.READ


class Dispatcher(ThreadedTaskDispatcher):
    """Gives each thread to the oldest request whose kind has one left."""

    def __init__(self) -> None:
        super().__init__()
        self._at_work: Counter[RequestKind] = Counter()

    def add_task(self, task: SharingChannel) -> None:
        task.begin_to_wait()
        super().add_task(task)

    def handler_thread(self, thread_no: int) -> None:
        """Work on requests until the server stops. Waitress calls it in each of its threads."""
        while True:
            with self.lock:
                while not self.stop_count and (channel := self._take()) is None:
                    self.active_count -= 1
                    self.queue_cv.wait(LOOK_SECONDS if self.queue else None)
                    self.active_count += 1
                if self.stop_count:
                    self.active_count -= 1
                    self.stop_count -= 1
                    self.threads.discard(thread_no)
                    self.thread_exit_cv.notify()
                    return
                assert channel is not None
                kind = channel.kind
                self._at_work[kind] += 1
            try:
                channel.service()
            except BaseException:
                logger.exception("Exception when servicing %r", channel)
            finally:
                with self.lock:
                    self._at_work[kind] -= 1
                    self.queue_cv.notify()

    def _take(self) -> SharingChannel | None:
        """Take the oldest request that may have a thread now or has waited too long; None where there is none.

        Called with the lock held.
        """
        now = time.monotonic()
        for channel in self.queue:
            channel.is_refused = not self._has_room(channel.kind)
            waited = now - channel.waits_since
            if not channel.is_refused or waited >= SHARES[channel.kind].patience:
                self.queue.remove(channel)
                taken: SharingChannel = channel
                return taken
        return None

    def _has_room(self, kind: RequestKind) -> bool:
        if kind is RequestKind.HEALTH:
            return True
        slow = sum(
            self._at_work[each] for each in (RequestKind.WRITE, RequestKind.LONG, RequestKind.BATCH)
        )
        if slow + self._at_work[RequestKind.READ] >= ALL_BUT_HEALTH:
            return False
        if kind is not RequestKind.READ and slow >= SLOW:
            return False
        return self._at_work[kind] < SHARES[kind].threads


class SharingTask(WSGITask):
    """Tells the application when a request is to be refused, and breaks an answer off that ends early."""

    def service(self) -> None:
        try:
            super().service()
        except BrokenOff as error:
            if not self.wrote_header:
                raise
            logger.warning("%s was broken off: %s", self.request.path, error)
            self.close_on_finish = True  # without the chunk that would say that all is there

    def get_environment(self) -> dict[str, Any]:
        environ: dict[str, Any] = super().get_environment()
        if self.channel.is_refused:
            environ[REFUSED] = self.channel.kind
        return environ


class SharingChannel(HTTPChannel):
    """A connection that knows what its request asks for, and since when it waits for a thread."""

    task_class = SharingTask
    kind = RequestKind.READ
    waits_since = 0.0
    is_refused = False

    def begin_to_wait(self) -> None:
        """Note the time, and what the next request asks of its thread."""
        request: HTTPRequestParser = self.requests[0]
        self.waits_since, self.is_refused, self.kind = time.monotonic(), False, RequestKind.READ
        if request.error is None:
            content_type = request.headers.get("CONTENT_TYPE", "")
            self.kind = kind_of(request.command, request.path, content_type)


class RefuseWhatWaited:
    """Middleware: answer 503 to what has waited too long for a thread, at next to no cost."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        kind = request.META.get(REFUSED)
        if kind is None:
            return self.get_response(request)
        seconds = SHARES[kind].retry_after
        sentence = f"{WHY[kind]} Try again in {seconds} seconds."
        response = refuse(request, 503, "The server is busy", sentence, "server_busy")
        response["Retry-After"] = str(seconds)
        return response
