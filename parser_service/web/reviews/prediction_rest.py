"""What runs answer."""

from __future__ import annotations

from typing import Any

import django_filters
from django.db.models import QuerySet
from django_filters.rest_framework import DjangoFilterBackend
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.response import Response

from annotations.showing.filtering import Key
from annotations.web.labelling.sending_rest import Sending, SentSerializer, WhatToLookAt
from annotations.web.rest.fields import FiniteField
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from parser_service.models import Prediction
from parser_service.results.prediction_filters import PredictionFilters
from parser_service.web.runs.run_rest import OfRun


class PredictionSerializer(serializers.ModelSerializer[Prediction]):
    """A ranked candidate of a run for an example, whose ``label`` is the label. ``is_cut``: the
    parser read only the beginning of the utterance. ``is_same_plan`` is null where plans were not compared."""

    run = serializers.IntegerField(source="run_id")
    example = serializers.IntegerField(source="example_id")
    utterance = serializers.CharField(source="example.utterance")
    label = serializers.CharField(source="example.logical_form")  # type: ignore[assignment]  # the name of the column
    score = FiniteField(allow_null=True)

    class Meta:
        model = Prediction
        fields = [
            *("id", "run", "example", "utterance", "label", "rank", "logical_form", "score"),
            *("is_exact_match", "is_equivalent", "is_well_formed", "is_same_plan"),
            *("answer_in_training", "label_in_training", "origin", "is_cut"),
        ]


class FiltersOfRun(DjangoFilterBackend):
    """Tells the filters which run the rows are of, which makes some of them quick."""

    def get_filterset_kwargs(self, request: ApiRequest, queryset: Any, view: Any) -> dict[str, Any]:
        return {**super().get_filterset_kwargs(request, queryset, view), "of_run": view.run()}


class PredictionQuery(PredictionFilters):
    """The filters of the page. Some have choices that only a world knows, so they are described as texts."""


for name in ("category", "slice", "answer_head", "versus"):
    extend_schema_field(OpenApiTypes.STR)(PredictionQuery.base_filters[name])


class Predictions(OfRun):
    """Lists the first answer of a run to every example, chosen as on the page, or by a saved slice."""

    model = Prediction
    serializer_class = PredictionSerializer
    filter_backends = [FiltersOfRun]
    filterset_class = PredictionQuery
    sorts = {"example": "example_id", "utterance": "example__utterance"}

    def rows(self) -> QuerySet[Prediction]:
        return self.run().predictions.best().select_related("example")


class SendPredictions(Sending, Predictions):
    """Sends what is behind the answers that the filters choose to the work queue."""

    @extend_schema(request=WhatToLookAt, responses={200: SentSerializer})
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        rows = self.filter_queryset(self.get_queryset()).order_by("example_id")
        return self.send(row.example for row in rows.iterator(chunk_size=500))


class CandidateQuery(django_filters.FilterSet):
    example = Key("example_id")

    class Meta:
        model = Prediction
        fields = ["rank"]


class Candidates(OfRun):
    """Lists all candidates of a run, the beam of each example together."""

    model = Prediction
    serializer_class = PredictionSerializer
    filterset_class = CandidateQuery
    sorts = {"id": "pk", "example": "example_id"}

    def rows(self) -> QuerySet[Prediction]:
        return self.run().predictions.select_related("example")
