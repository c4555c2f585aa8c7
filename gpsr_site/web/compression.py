"""Middleware: compress text for clients that accept it."""

from __future__ import annotations

import re

from django.http import HttpRequest, HttpResponseBase
from django.middleware.gzip import GZipMiddleware

TEXT = re.compile(r"text/|application/([\w.-]+\+)?(json|yaml|xml|vnd\.oai\.openapi)")


class CompressTexts(GZipMiddleware):
    """Compresses pages and answers of REST, with random bytes against guessing secrets by length (BREACH).

    Answers that are sent in pieces stay as they are: a reader of JSON lines wants each as soon as it is
    there, and archives and Parquet are compressed already. So does one row with its ``ETag``, which would become weak:
    no write could name its version by that. Static files are WhiteNoise's.
    """

    def process_response(
        self, request: HttpRequest, response: HttpResponseBase
    ) -> HttpResponseBase:
        kind = response.get("Content-Type", "")
        is_row = response.has_header("ETag") and kind.startswith("application/json")
        if response.streaming or is_row or not TEXT.match(kind):
            return response
        return super().process_response(request, response)
