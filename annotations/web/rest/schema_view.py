"""The OpenAPI schema as a file, made once for each process."""

from __future__ import annotations

import hashlib
from threading import Lock
from typing import Any

from django.http import HttpResponse, HttpResponseBase
from django.utils.cache import get_conditional_response
from drf_spectacular.renderers import (
    OpenApiJsonRenderer,
    OpenApiJsonRenderer2,
    OpenApiYamlRenderer,
    OpenApiYamlRenderer2,
)
from drf_spectacular.settings import spectacular_settings
from drf_spectacular.utils import extend_schema
from drf_spectacular.views import SpectacularAPIView
from rest_framework.exceptions import ValidationError
from rest_framework.permissions import AllowAny
from rest_framework.request import Request

_made: dict[str, tuple[bytes, str]] = {}
_making = Lock()


class SchemaFile(SpectacularAPIView):
    """Gives the schema out as JSON, or as YAML where ``?format=yaml`` or the header Accept asks for it,
    with the tag of its version.

    It says what exists and shows no row, so that tools may read it without a token, and it is the same
    for every caller; routes change with the code alone, hence once for each process is enough.
    """

    permission_classes = [AllowAny]
    renderer_classes = [
        OpenApiJsonRenderer2,
        OpenApiJsonRenderer,
        OpenApiYamlRenderer,
        OpenApiYamlRenderer2,
    ]

    @extend_schema(exclude=True)
    def get(self, request: Request, *args: object, **kwargs: object) -> HttpResponseBase:
        kind = request.accepted_renderer.media_type
        with _making:
            if kind not in _made:
                generator: Any = self.generator_class()
                schema = generator.get_schema(public=True)
                made: Any = request.accepted_renderer.render(schema, renderer_context={})
                _made[kind] = made, f'W/"{hashlib.sha256(made).hexdigest()[:20]}"'
        content, tag = _made[kind]
        answer = HttpResponse(content, content_type=kind)
        name = f"{spectacular_settings.TITLE}.{request.accepted_renderer.format}"
        answer["Content-Disposition"] = f'inline; filename="{name}"'
        answer["ETag"] = tag
        answer["Cache-Control"] = "no-cache"  # kept, and asked about before it is used again
        return get_conditional_response(request._request, etag=tag, response=answer) or answer

    def perform_content_negotiation(self, request: Request, force: bool = False) -> Any:
        """Choose by ``format`` of the address, and without one by the header Accept."""
        wanted = request.query_params.get("format")
        if wanted is None or force:
            return super().perform_content_negotiation(request, force)
        for renderer in self.get_renderers():
            if renderer.format == wanted:
                return renderer, renderer.media_type
        raise ValidationError({"format": ["The schema is written as json or yaml."]})
