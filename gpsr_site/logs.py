"""The format of log lines, without secrets."""

from __future__ import annotations

import json
import logging
import re
from contextvars import ContextVar
from datetime import UTC, datetime
from typing import Any

# Keys of links, and all that a crowd market says of somebody, by whatever names.
SECRET_ADDRESS = re.compile(
    r"(/join/|/password/[^/\s?]+/|[?&](?:PROLIFIC_PID|SESSION_ID|workerId|assignmentId)=)[^/\s?&]+"
    r"|(/p/[^\s?]{0,200}\?)\S+"
)
REQUEST_ID: ContextVar[str] = ContextVar("request_id", default="")


class HideSecrets(logging.Filter):
    """Replaces the secrets of links, which stand in the addresses of requests, by three dots."""

    def filter(self, record: logging.LogRecord) -> bool:
        message = record.getMessage()
        hidden = hide_secrets(message)
        if hidden != message:
            record.msg, record.args = hidden, ()
        return True


class RefusedInOneLine(logging.Filter):
    """Takes the traceback from what Django refuses, such as an unknown host: that says nothing of this code."""

    def filter(self, record: logging.LogRecord) -> bool:
        if record.name.startswith("django.security."):
            record.exc_info = record.exc_text = None
        return True


class JsonLines(logging.Formatter):
    """One JSON object a line: what programs that collect logs read.

    ``fields``, which a caller gives as ``extra={"fields": {…}}``, stand beside the message.
    """

    def format(self, record: logging.LogRecord) -> str:
        values: dict[str, Any] = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname,
            "logger": record.name,
            "message": record.getMessage(),
            **getattr(record, "fields", {}),
        }
        if request_id := REQUEST_ID.get():
            values["request_id"] = request_id
        if record.exc_info:
            values["exception"] = hide_secrets(self.formatException(record.exc_info))
        return json.dumps(values, ensure_ascii=False, default=str)


def hide_secrets(text: str) -> str:
    """Return a text without the secrets of the links in it."""
    return SECRET_ADDRESS.sub(r"\1\2…", text)
