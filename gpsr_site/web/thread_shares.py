"""How many slow requests a web process takes at once, so that threads are left for pages and ``/healthz``.

Writers wait for each other (SQLite has one at a time), batches and downloads compute for long. What finds no
thread of its share is answered 503, with the time to try again.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from enum import Enum
from threading import BoundedSemaphore

from django.conf import settings
from django.http import HttpRequest
from django.http.response import HttpResponseBase
from rest_framework.permissions import SAFE_METHODS

from annotations.people.allowances import allowance_at
from annotations.web.rest.streaming import JSON_LINES_TYPES
from gpsr_site.web.refusals import refuse

# Each keeps a connection to the database, and PostgreSQL takes 100 by default.
THREADS = 40 if settings.WEB_PROCESSES == 1 else max(16, 64 // settings.WEB_PROCESSES)
# REST takes them by other spellings too, such as */JSONL.
LINES = tuple(each.partition("/")[2] for each in JSON_LINES_TYPES)


class SlowKind(Enum):
    """What keeps a thread for long."""

    WRITE = "write"
    LONG = "long"
    BATCH = "batch"


@dataclass(frozen=True, slots=True)
class ThreadShare:
    """At most ``threads`` at once, of which ``at_work`` work and the others wait for ``patience`` seconds. Who is
    refused is told ``why``, and to try again after ``retry_after`` seconds."""

    threads: int
    at_work: int
    patience: float
    retry_after: int
    why: str


SHARES = {
    SlowKind.WRITE: ThreadShare(THREADS - 8, 5, 10, 5, "Others are writing. Nothing was saved."),
    SlowKind.LONG: ThreadShare(3, 3, 0, 30, "Others make or download large files."),
    SlowKind.BATCH: ThreadShare(
        *(2, 2, 0, 10),
        "Others have batches parsed. A batch can also be given to a worker: POST it to parse/jobs/.",
    ),
}


def kind_of(method: str, path: str, content_type: str = "") -> SlowKind | None:
    """Return what a request asks of its thread, as the view at its address says; None where it is quick."""
    allowance = allowance_at(path)
    if method in SAFE_METHODS:
        return SlowKind.LONG if allowance.may_take_long else None
    if not allowance.only_reads:
        return SlowKind.WRITE
    sent = content_type.lower()
    return SlowKind.BATCH if any(each in sent for each in LINES) else None


class ThreadShares:
    """Middleware: take as many slow requests as their kind has threads."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponseBase]) -> None:
        self.get_response = get_response
        self.limits = {
            kind: [
                (BoundedSemaphore(share.threads), 0.0),
                (BoundedSemaphore(share.at_work), share.patience),
            ]
            for kind, share in SHARES.items()
        }

    def __call__(self, request: HttpRequest) -> HttpResponseBase:
        kind = kind_of(
            request.method or "", request.path_info, request.META.get("CONTENT_TYPE", "")
        )
        if kind is None:
            return self.get_response(request)
        with ExitStack() as held:
            for free, seconds in self.limits[kind]:
                if not free.acquire(timeout=seconds):
                    return _refuse(request, SHARES[kind])
                held.callback(free.release)
            response = self.get_response(request)
            if response.streaming:  # its pieces are made later; the server closes it after the last
                held.callback(response.close)
                response.close = held.pop_all().close  # type: ignore[method-assign]
            return response


def _refuse(request: HttpRequest, share: ThreadShare) -> HttpResponseBase:
    sentence = f"{share.why} Try again in {share.retry_after} seconds."
    response = refuse(request, 503, "The server is busy", sentence, "server_busy")
    response["Retry-After"] = str(share.retry_after)
    return response
