"""How routes are described in the OpenAPI schema, beside what drf-spectacular reads from them."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from drf_spectacular.openapi import AutoSchema
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter
from rest_framework.permissions import AllowAny

from annotations.web.problems import CONTENT_TYPE
from annotations.web.rest.fields import with_problems
from annotations.web.rest.idempotency import HEADER
from annotations.web.rest.permissions import asked_of
from annotations.web.rest.problem_details import ProblemSerializer

IF_MATCH = OpenApiParameter(
    "If-Match",
    OpenApiTypes.STR,
    OpenApiParameter.HEADER,
    required=True,
    description="The ETag of the row as it was read; * for whichever it is.",
)
KEY = OpenApiParameter(
    HEADER,
    OpenApiTypes.STR,
    OpenApiParameter.HEADER,
    description="Any text of your own. Sent again within a day, it is answered as the first time.",
)
REASONS = {
    HTTPStatus.BAD_REQUEST: "What was sent has problems, or cannot be read.",
    HTTPStatus.UNAUTHORIZED: "No token, or one that is not valid.",
    HTTPStatus.FORBIDDEN: "Your role in this world does not allow this.",
    HTTPStatus.NOT_FOUND: "There is no such thing in a world that you can see.",
    HTTPStatus.NOT_ACCEPTABLE: "The API does not speak a type that the header Accept names.",
    HTTPStatus.CONFLICT: "It does not fit what is stored by now.",
    HTTPStatus.PRECONDITION_FAILED: "It has changed since you read it; “current” is what it is now.",
    HTTPStatus.REQUEST_ENTITY_TOO_LARGE: "More than this address takes.",
    HTTPStatus.UNSUPPORTED_MEDIA_TYPE: "The body is of a type that this address does not take.",
    HTTPStatus.UNPROCESSABLE_ENTITY: "Files were refused, or a key was sent with another request.",
    HTTPStatus.PRECONDITION_REQUIRED: "The header If-Match is missing.",
}
ALWAYS = (
    *(HTTPStatus.BAD_REQUEST, HTTPStatus.UNAUTHORIZED, HTTPStatus.FORBIDDEN),
    *(HTTPStatus.NOT_FOUND, HTTPStatus.NOT_ACCEPTABLE),
)
OF_WRITES = (
    *(HTTPStatus.CONFLICT, HTTPStatus.REQUEST_ENTITY_TOO_LARGE),
    *(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, HTTPStatus.UNPROCESSABLE_ENTITY),
)
OF_CHANGES = (HTTPStatus.PRECONDITION_FAILED, HTTPStatus.PRECONDITION_REQUIRED)


class Schema(AutoSchema):
    """Adds the headers that a route reads and the problems that it answers with."""

    def get_override_parameters(self) -> list[Any]:
        given = [*super().get_override_parameters()]
        if self._changes_rows:
            given.append(IF_MATCH)
        handler = getattr(self.view, "action", None) or self.method.lower()
        if getattr(getattr(self.view, handler, None), "takes_key", False):
            given.append(KEY)
        return given

    def get_request_serializer(self) -> Any:
        """Return the serializer for the body: of a new row, or of a change."""
        names = dict.fromkeys(("POST", "create"), "new_serializer")
        names |= dict.fromkeys(("PATCH", "partial_update"), "change_serializer")
        return getattr(self.view, names.get(self._asked, ""), None) or (
            super().get_request_serializer()
        )

    def get_response_serializers(self) -> Any:
        """Return the serializer for the answer to a write: the row with the checker's problems."""
        writes = ("POST", "PATCH", "create", "partial_update")
        if self._asked in writes and hasattr(self.view, "new_serializer"):
            return with_problems(getattr(self.view, "serializer_class", None))
        return super().get_response_serializers()

    def get_tags(self) -> list[str]:
        """Name the noun that a route is about."""
        tokens = self._tokenize_path()
        return [tokens[1] if len(tokens) > 1 and tokens[0] == "worlds" else tokens[0]]

    def get_operation(self, *args: Any, **kwargs: Any) -> dict[str, Any] | None:
        operation = super().get_operation(*args, **kwargs)
        if operation is None or AllowAny in self.view.permission_classes:
            return operation
        problem = self.resolve_serializer(ProblemSerializer(), "response").ref
        content = {CONTENT_TYPE: {"schema": problem}}
        statuses = [*ALWAYS, *(OF_WRITES if self.method != "GET" else ())]
        statuses += OF_CHANGES if self._changes_rows else ()
        for status in statuses:
            answer = {"description": REASONS[status], "content": content}
            operation["responses"][str(int(status))] = answer
        return operation

    @property
    def _asked(self) -> str:
        return asked_of(self.view, self.method)

    @property
    def _changes_rows(self) -> bool:
        return self._asked in getattr(self.view, "conditional", ())
