"""Lists by keyset: a page costs the same however far it is from the start."""

from __future__ import annotations

from base64 import urlsafe_b64decode, urlsafe_b64encode
from typing import Any

from django.db.models import QuerySet
from rest_framework.exceptions import ValidationError
from rest_framework.pagination import BasePagination
from rest_framework.request import Request
from rest_framework.response import Response
from rest_framework.utils.urls import replace_query_param

from annotations.showing.paging import opposite, page_of, read_cursor

PAGE_SIZE, MOST_ROWS = 100, 1000
PLACES = ("after", "before")


class Keyset(BasePagination):
    """Pages in the order that ``sort`` names; ``next`` and ``previous`` are addresses, null at an end.

    A route says by ``sorts`` what it can be sorted by, name → field that is never null; the first one is
    the default.
    """

    def paginate_queryset(self, queryset: Any, request: Request, view: Any = None) -> list[Any]:
        self.address = request.build_absolute_uri()
        order = self._order(request, view.sorts)
        cursors = {name: self._cursor(request, queryset, order, name) for name in PLACES}
        size = PAGE_SIZE
        if sent := request.query_params.get("limit", ""):
            is_number = sent.isascii() and sent.isdigit() and len(sent) < 6
            if not is_number or not 1 <= int(sent) <= MOST_ROWS:
                raise ValidationError({"limit": [f"Ask for 1 to {MOST_ROWS} rows."]})
            size = int(sent)
        self.page = page_of(queryset, order, **cursors, size=size)
        return self.page.rows

    def get_paginated_response(self, data: Any) -> Response:
        next_, previous = self._link("after"), self._link("before")
        return Response({"next": next_, "previous": previous, "results": data})

    def _link(self, name: str) -> str | None:
        cursor = getattr(self.page, name)
        if not cursor:
            return None
        address = self.address
        for each in PLACES:
            written = urlsafe_b64encode(cursor.encode()).decode() if each == name else ""
            address = replace_query_param(address, each, written)
        return address

    def _order(self, request: Request, sorts: dict[str, str]) -> str:
        asked = request.query_params.get("sort") or next(iter(sorts))
        field = sorts.get(asked.removeprefix("-"))
        if field is None:
            raise ValidationError({"sort": [f"Sort by one of: {', '.join(sorts)}."]})
        return opposite(field) if asked.startswith("-") else field

    def _cursor(self, request: Request, rows: QuerySet[Any], order: str, name: str) -> str:
        """Return the cursor that was sent. Raises ValidationError for one of another order."""
        sent = request.query_params.get(name, "")
        try:
            cursor = urlsafe_b64decode(sent.encode()).decode()
        except ValueError:
            cursor = ""
        if sent and (not cursor or read_cursor(rows.model, order, cursor) is None):
            raise ValidationError({name: ["This is no cursor of this list. Begin without one."]})
        return cursor

    def get_paginated_response_schema(self, schema: dict[str, Any]) -> dict[str, Any]:
        link = {"type": ["string", "null"], "format": "uri"}
        return {
            "type": "object",
            "required": ["next", "previous", "results"],
            "properties": {"next": link, "previous": link, "results": schema},
        }

    def get_schema_operation_parameters(self, view: Any) -> list[dict[str, Any]]:
        orders = [f"{sign}{name}" for name in view.sorts for sign in ("", "-")]
        texts = {
            "after": "A cursor from “next”.",
            "before": "A cursor from “previous”.",
        }
        cursors = [_parameter(name, text, {"type": "string"}) for name, text in texts.items()]
        size = {"type": "integer", "minimum": 1, "maximum": MOST_ROWS, "default": PAGE_SIZE}
        return [
            *cursors,
            _parameter("limit", "Rows of a page.", size),
            _parameter("sort", "The order, - for descending.", {"type": "string", "enum": orders}),
        ]


def _parameter(name: str, text: str, schema: dict[str, Any]) -> dict[str, Any]:
    return {"name": name, "in": "query", "required": False, "description": text, "schema": schema}
