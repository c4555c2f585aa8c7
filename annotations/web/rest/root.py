"""What is at ``/api/v1/``: all addresses of the API."""

from __future__ import annotations

from functools import cache
from typing import Any

from django.urls import reverse
from drf_spectacular.generators import EndpointEnumerator
from drf_spectacular.utils import extend_schema
from rest_framework.permissions import AllowAny
from rest_framework.request import Request
from rest_framework.response import Response
from rest_framework.views import APIView


class ApiRoot(APIView):
    """Lists the addresses with their methods. Like the schema, it shows no row and needs no token."""

    permission_classes = [AllowAny]

    @extend_schema(exclude=True)
    def get(self, request: Request) -> Response:
        return Response(
            {
                "schema": reverse("api:schema"),
                "documents": reverse("document", kwargs={"shelf": "reference", "page": "rest"}),
                "addresses": _addresses(),
            }
        )


@cache
def _addresses() -> dict[str, list[str]]:
    """Return address → its methods. They change with the code alone."""
    addresses: dict[str, list[str]] = {}
    enumerator: Any = EndpointEnumerator()
    for path, _, method, _ in enumerator.get_api_endpoints():
        as_in_schema = path.replace("{pk}", "{id}")
        addresses.setdefault(as_in_schema, []).append(method)
    return addresses
