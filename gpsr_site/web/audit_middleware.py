"""Middleware: write every request that changes something into the audit log."""

from __future__ import annotations

import logging
from collections.abc import Callable

from django.db import DatabaseError
from django.http import HttpRequest, HttpResponse

from annotations.people.audit_log import record

logger = logging.getLogger(__name__)


class AuditLog:
    """Records a request after it was answered. What it did stays done where that fails."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        response = self.get_response(request)
        try:
            record(request, response)
        except DatabaseError:
            logger.exception("An entry of the audit log could not be written.")
        return response
