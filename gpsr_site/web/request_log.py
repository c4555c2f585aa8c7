"""Middleware: each request has an id, which its log lines and its response bear."""

from __future__ import annotations

import logging
import re
import time
import uuid
from collections.abc import Callable

from django.conf import settings
from django.http import HttpRequest, HttpResponse

from gpsr_site.logs import REQUEST_ID, hide_secrets

logger = logging.getLogger("gpsr_site.requests")

HEADER = "X-Request-ID"
READABLE = re.compile(r"[A-Za-z0-9_.-]{1,64}")


class RequestLog:
    """Takes the id that a proxy has given, or makes one. Logs a line for each request as JSON.

    Lines for people leave requests out: only what goes wrong stands there.
    """

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        given = request.headers.get(HEADER, "")
        request_id = given if READABLE.fullmatch(given) else uuid.uuid4().hex
        token, began = REQUEST_ID.set(request_id), time.monotonic()
        try:
            response = self.get_response(request)
            response[HEADER] = request_id
            if settings.LOG_FORMAT == "json":
                user = getattr(request, "user", None)
                fields = {  # no query: people search for what they like
                    "method": request.method,
                    "path": hide_secrets(request.path),
                    "status": response.status_code,
                    "milliseconds": round((time.monotonic() - began) * 1000, 1),
                    "address": request.META.get("REMOTE_ADDR", ""),
                    "user": user.pk if user is not None and user.is_authenticated else None,
                }
                logger.info("request", extra={"fields": fields})
        finally:
            REQUEST_ID.reset(token)
        return response
