"""Middleware: compress text for clients that accept it."""

from __future__ import annotations

import re

from django.http import HttpRequest, HttpResponseBase
from django.middleware.gzip import GZipMiddleware

TEXT = re.compile(r"text/|application/([\w.-]+\+)?(json|yaml|xml|vnd\.oai\.openapi)")


class CompressTexts(GZipMiddleware):
    """Compresses pages and answers of REST, with random bytes against guessing secrets by length (BREACH).

    Answers that are sent in pieces stay as they are: a reader of JSON lines wants each as soon as it is
    there, and archives and Parquet are compressed already. So does what has a strong ``ETag``, as one row has: it
    would become weak, and no write could name its version by that. Static files are WhiteNoise's.
    """

    def process_response(
        self, request: HttpRequest, response: HttpResponseBase
    ) -> HttpResponseBase:
        kind = response.get("Content-Type", "")
        has_strong_tag = response.get("ETag", "").startswith('"')
        if response.streaming or has_strong_tag or not TEXT.match(kind):
            return response
        return super().process_response(request, response)
