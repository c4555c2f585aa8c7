"""In which type a route answers."""

from __future__ import annotations

from collections.abc import Iterable

from rest_framework.negotiation import BaseContentNegotiation
from rest_framework.parsers import BaseParser
from rest_framework.renderers import BaseRenderer
from rest_framework.request import Request

from annotations.exchange.split_export import SplitFormat

# Suffix of a file → its type.
CONTENT_TYPES: dict[str, str] = {
    SplitFormat.TXT: "text/plain; charset=utf-8",
    SplitFormat.JSONL: "application/jsonl; charset=utf-8",
    SplitFormat.CSV: "text/csv; charset=utf-8",
    SplitFormat.PARQUET: "application/vnd.apache.parquet",
    SplitFormat.ZIP: "application/zip",
    SplitFormat.DATASETS: "application/zip",
    "conllup": "text/plain; charset=utf-8",
    "json": "application/json; charset=utf-8",
    "tex": "application/x-tex; charset=utf-8",
}


class AnyType(BaseContentNegotiation):
    """For routes that answer with files, whose type the address names: any header ``Accept`` will do."""

    def select_renderer(
        self, request: Request, renderers: Iterable[BaseRenderer], format_suffix: str | None = None
    ) -> tuple[BaseRenderer, str]:
        renderer = next(iter(renderers))
        return renderer, renderer.media_type

    def select_parser(self, request: Request, parsers: Iterable[BaseParser]) -> BaseParser:
        return next(iter(parsers))
