"""Reads the bodies that are sent to the API. The texts in them are normalised here, for every route."""

from __future__ import annotations

from typing import Any

from rest_framework.exceptions import ParseError
from rest_framework.parsers import DataAndFiles, JSONParser, MultiPartParser

from annotations.web.sent_texts import SentTexts, sent_texts_of


class BoundedJSONParser(JSONParser):
    """Reads JSON. Raises ParseError where it nests too deep, NotText where it holds what is no text."""

    def parse(self, stream: Any, media_type: Any = None, parser_context: Any = None) -> Any:
        try:
            sent = super().parse(stream, media_type, parser_context)
        except RecursionError:
            raise ParseError("The JSON nests too deep.") from None
        return _texts_in(parser_context).read_json(sent)


class FilesParser(MultiPartParser):
    """Reads files and the fields beside them."""

    def parse(self, stream: Any, media_type: Any = None, parser_context: Any = None) -> Any:
        sent = super().parse(stream, media_type, parser_context)
        return DataAndFiles(_texts_in(parser_context).read_form(sent.data), sent.files)


def _texts_in(parser_context: Any) -> SentTexts:
    return sent_texts_of(parser_context["request"]._request)
