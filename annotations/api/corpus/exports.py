"""Splits as files: pair files, JSON Lines, CSV."""

from __future__ import annotations

from django.http import StreamingHttpResponse
from django.shortcuts import get_object_or_404
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.request import Request

from annotations.api.negotiation import AnyType
from annotations.api.routes import WorldRoute
from annotations.auditing import examples_before
from annotations.exporting.split_export import FIELDS, Format, export_lines
from annotations.models import Example, Split
from annotations.models.splits import Source, part_choices

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


class ExportedExampleSerializer(serializers.ModelSerializer):
    """One line of a JSON Lines export."""

    class Meta:
        model = Example
        fields = FIELDS


class ExportQuery(serializers.Serializer):
    """What may be asked of an export. Text needs ``part`` and ``source``: it is one pair file."""

    part = serializers.ChoiceField(choices=part_choices(), required=False)
    source = serializers.ChoiceField(choices=Source.choices, required=False)

    def get_fields(self) -> dict[str, serializers.Field]:
        # "as" is a word of Python and cannot be a class attribute.
        as_ = serializers.ChoiceField(choices=Format.choices, default=Format.JSONL)
        return {"as": as_, **super().get_fields()}

    def validate(self, query: dict[str, str]) -> dict[str, str]:
        if query["as"] == Format.TXT and not ("part" in query and "source" in query):
            raise serializers.ValidationError(
                "A text export is one pair file: add part=train|validation|test and "
                "source=generated|paraphrased."
            )
        return query


class SplitExport(WorldRoute):
    """Streams the examples of a frozen split as pair files, JSON Lines or CSV."""

    model = Split
    content_negotiation_class = AnyType

    @extend_schema(
        operation_id="split_export",
        parameters=[ExportQuery, FOUND_WRONG],
        responses={
            (200, "application/jsonl"): ExportedExampleSerializer(many=True),
            (200, "text/csv"): OpenApiTypes.STR,
            (200, "text/plain"): OpenApiTypes.STR,
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
