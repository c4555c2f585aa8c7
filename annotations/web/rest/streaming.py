"""Answers that are sent in pieces."""

from __future__ import annotations

from collections.abc import Iterable

from django.http import StreamingHttpResponse

from annotations.web.rest.negotiation import CONTENT_TYPES

JSON_LINES = "application/jsonl"
# What programs call the same.
JSON_LINES_TYPES = (
    JSON_LINES,
    *("application/x-jsonl", "application/jsonlines", "application/x-jsonlines"),
    *("application/ndjson", "application/x-ndjson"),
)


class BrokenOff(Exception):
    """An answer ends before all of it was sent; a sentence says why.

    Raised while the pieces are sent. The web server then closes the connection without the end of the
    answer, so that no client takes it for whole.
    """


def attachment(pieces: Iterable[bytes], format: str, name: str) -> StreamingHttpResponse:
    """Send a file in pieces, to be kept under ``name``. ``format`` is one of ``CONTENT_TYPES``."""
    response = StreamingHttpResponse(pieces, content_type=CONTENT_TYPES[format])
    response["Content-Disposition"] = f'attachment; filename="{name}"'
    return response
