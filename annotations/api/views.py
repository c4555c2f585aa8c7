"""The routes of the API."""

from __future__ import annotations

from django.http import StreamingHttpResponse
from django.shortcuts import get_object_or_404
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, OpenApiResponse, extend_schema
from rest_framework.request import Request
from rest_framework.views import APIView

from annotations.api.permissions import HasDuty
from annotations.api.serializers import ExampleSerializer, ExportQuery
from annotations.auditing import examples_before
from annotations.exporting.split_export import Format, export_lines
from annotations.models import Duty, Split, World

CONTENT_TYPES = {
    Format.TXT: "text/plain; charset=utf-8",
    Format.JSONL: "application/jsonl; charset=utf-8",
    Format.CSV: "text/csv; charset=utf-8",
}

FOUND_WRONG = OpenApiParameter(
    "X-Pairs-Found-Wrong",
    OpenApiTypes.INT,
    OpenApiParameter.HEADER,
    response=[200],
    description="Pairs of the split that label audits have corrected or excluded since it was frozen.",
)


class SplitExport(APIView):
    """Streams the examples of a frozen split as pair files, JSON Lines or CSV."""

    permission_classes = [HasDuty]
    duty = Duty.VIEW
    world: World

    @extend_schema(
        operation_id="split_export",
        parameters=[ExportQuery, FOUND_WRONG],
        responses={
            (200, "application/jsonl"): ExampleSerializer(many=True),
            (200, "text/csv"): OpenApiTypes.STR,
            (200, "text/plain"): OpenApiTypes.STR,
            400: OpenApiResponse(description="A parameter is missing or unknown."),
            401: OpenApiResponse(description="No token, or one that is not valid."),
            404: OpenApiResponse(description="No such split in a world that you can see."),
        },
    )
    def get(self, request: Request, world: str, pk: int) -> StreamingHttpResponse:
        split = get_object_or_404(Split, world=self.world, pk=pk)
        query = ExportQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        chosen = query.validated_data
        lines = export_lines(split, chosen["as"], chosen.get("part"), chosen.get("source"))
        response = StreamingHttpResponse(lines, content_type=CONTENT_TYPES[chosen["as"]])
        name = "-".join(filter(None, [split.name, chosen.get("source"), chosen.get("part")]))
        response[FOUND_WRONG.name] = str(examples_before(split).count())
        response["Content-Disposition"] = f'attachment; filename="{name}.{chosen["as"]}"'
        return response
