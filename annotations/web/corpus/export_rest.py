"""Splits as files: pair files, JSON Lines, CSV, Parquet, a data set of Hugging Face."""

from __future__ import annotations

from typing import Any

from django.http import StreamingHttpResponse
from django.shortcuts import get_object_or_404
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.exchange.split_export import FIELDS, SplitFormat, export_pieces
from annotations.exchange.split_manifest import manifest_of
from annotations.labelling.label_changes import examples_before
from annotations.models import Example, Split
from annotations.models.splits import Source, part_choices
from annotations.people.allowances import may_take_long
from annotations.web.rest.negotiation import CONTENT_TYPES, AnyType
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldRoute
from annotations.web.rest.samples import SampleNoteSerializer

FOUND_WRONG = OpenApiParameter(
    "X-Pairs-Found-Wrong",
    OpenApiTypes.INT,
    OpenApiParameter.HEADER,
    response=[200],
    description="Pairs of the split that label audits have corrected or excluded since it was frozen.",
)

HASH = OpenApiParameter(
    "X-Content-Hash",
    OpenApiTypes.STR,
    OpenApiParameter.HEADER,
    response=[200],
    description="The SHA-256 of all examples of the split, as in its manifest.",
)


class ExportedExampleSerializer(serializers.ModelSerializer[Example]):
    """One line of a JSON Lines export."""

    class Meta:
        model = Example
        fields = FIELDS


class ManifestQuery(serializers.Serializer[Any]):
    """Which examples of a split; all of them where nothing is asked."""

    part = serializers.ChoiceField(choices=part_choices(), required=False)
    source = serializers.ChoiceField(choices=Source.choices, required=False)  # type: ignore[assignment]  # the name of the column


class ExportQuery(ManifestQuery):
    """What may be asked of an export. Text needs ``part`` and ``source``: it is one pair file."""

    def get_fields(self) -> dict[str, Any]:
        # "as" is a word of Python and cannot be a class attribute.
        as_ = serializers.ChoiceField(choices=SplitFormat.choices, default=SplitFormat.JSONL)
        return {"as": as_, **super().get_fields()}

    def validate(self, query: dict[str, str]) -> dict[str, str]:
        if query["as"] == SplitFormat.TXT and not ("part" in query and "source" in query):
            raise serializers.ValidationError(
                "A text export is one pair file: add part=train|validation|test and "
                f"source={'|'.join(Source)}."
            )
        return query


class ManifestSerializer(serializers.Serializer[Any]):
    """What an export is. ``counts`` are examples by source and part; ``content_hash`` is that of the split."""

    format = serializers.CharField()
    version = serializers.IntegerField()
    world = serializers.CharField()
    split = serializers.CharField()
    criterion = serializers.CharField()
    seed = serializers.IntegerField(allow_null=True)
    proportions = serializers.ListField(child=serializers.FloatField())
    tests_on_models = serializers.BooleanField()
    sample = SampleNoteSerializer(allow_null=True)
    content_hash = serializers.CharField()
    created_at = serializers.DateTimeField()
    chosen = serializers.DictField(child=serializers.CharField())
    counts = serializers.DictField(child=serializers.DictField(child=serializers.IntegerField()))
    examples = serializers.IntegerField()
    code_version = serializers.CharField()


class OfSplit(WorldRoute):
    model = Split

    def split(self) -> Split:
        """Return the split of the address. Raises Http404."""
        splits = self.world.splits.select_related("world")
        return get_object_or_404(splits, pk=self.kwargs["pk"])

    def asked(self, serializer: type[ManifestQuery]) -> dict[str, str]:
        """Return what the address asks for. Raises ValidationError."""
        query = serializer(data=self.request.query_params)
        query.is_valid(raise_exception=True)
        return dict(query.validated_data)


class SplitManifest(OfSplit):
    """Says what an export of a split is: its hash, criterion and counts, and which code made it."""

    @extend_schema(
        operation_id="split_manifest",
        parameters=[ManifestQuery],
        responses={200: ManifestSerializer},
    )
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        return Response(manifest_of(self.split(), **self.asked(ManifestQuery)))


@may_take_long
class SplitExport(OfSplit):
    """Streams the examples of a frozen split as pair files, tables, or a data set of Hugging Face.

    The manifest stands at ``manifest/``, and inside Parquet files and archives of pair files.
    """

    content_negotiation_class = AnyType

    @extend_schema(
        operation_id="split_export",
        parameters=[ExportQuery, FOUND_WRONG, HASH],
        responses={
            (200, "application/jsonl"): ExportedExampleSerializer(many=True),
            (200, "text/csv"): OpenApiTypes.STR,
            (200, "text/plain"): OpenApiTypes.STR,
            (200, "application/vnd.apache.parquet"): OpenApiTypes.BINARY,
            (200, "application/zip"): OpenApiTypes.BINARY,
        },
    )
    def get(self, request: ApiRequest, **kwargs: object) -> StreamingHttpResponse:
        split, chosen = self.split(), self.asked(ExportQuery)
        as_, part, source = chosen["as"], chosen.get("part"), chosen.get("source")
        pieces = export_pieces(split, as_, part, source)
        response = StreamingHttpResponse(pieces, content_type=CONTENT_TYPES[SplitFormat(as_)])
        name = "-".join(filter(None, [split.name, source, part]))
        response[FOUND_WRONG.name] = str(examples_before(split).count())
        response[HASH.name] = split.content_hash
        response["Link"] = '<../manifest/>; rel="describedby"'
        suffix = "datasets.zip" if as_ == SplitFormat.DATASETS else as_
        response["Content-Disposition"] = f'attachment; filename="{name}.{suffix}"'
        return response
