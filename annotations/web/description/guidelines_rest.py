"""The guidelines for annotators."""

from __future__ import annotations

from typing import Any

from django.db import transaction
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.editing.edits import add, change
from annotations.models import Duty, Guidelines
from annotations.models.description import MOST_CHARACTERS_OF_GUIDELINES
from annotations.showing.markdown import rendered
from annotations.web.rest.fields import Fields
from annotations.web.rest.matching import etag_of, require_match
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldRoute


class GuidelinesSerializer(serializers.ModelSerializer[Guidelines]):
    """``text`` is Markdown, ``html`` what pages show. ``id`` is null and ``version`` 0 until somebody writes them."""

    id = serializers.IntegerField(allow_null=True, read_only=True)
    html = serializers.SerializerMethodField()

    class Meta:
        model = Guidelines
        fields = ["id", "text", "html", "version"]

    def get_html(self, row: Guidelines) -> str:
        return rendered(row.text)


class GuidelinesChange(Fields):
    text = serializers.CharField(
        max_length=MOST_CHARACTERS_OF_GUIDELINES, allow_blank=True, trim_whitespace=False
    )


class OneGuidelines(WorldRoute):
    """Shows the guidelines for annotators, and writes them."""

    model = Guidelines
    serializer_class = GuidelinesSerializer
    filter_backends = []
    pagination_class = None
    duties = {"PATCH": Duty.MANAGE}
    conditional = ("PATCH",)

    @extend_schema(operation_id="guidelines", responses={200: GuidelinesSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        row = self._row()
        shown = self._shown(row)
        return Response(shown, headers={"ETag": etag_of(row, shown)})

    @extend_schema(
        operation_id="write_guidelines",
        request=GuidelinesChange,
        responses={200: GuidelinesSerializer},
    )
    def patch(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(GuidelinesChange, partial=True)
        with transaction.atomic():
            self.hold_world()
            row = self._row()
            shown = self._shown(row)
            require_match(request, row, shown)
            text = sent.get("text", row.text)
            if row.pk is None:
                row.text = text
                add(row, request.user)
            else:
                change(row, {"text": text}, request.user, row.version)
        return self.get(request)

    def _row(self) -> Guidelines:
        """Return the row of the world, or an unsaved one."""
        return self.world.guidelines.first() or Guidelines(world=self.world, version=0)

    def _shown(self, row: Guidelines) -> dict[str, Any]:
        return dict(self.get_serializer(row).data)
