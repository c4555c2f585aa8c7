"""What runs answer, and how often that is right."""

from __future__ import annotations

from typing import Any, ClassVar

import django_filters
from django.db.models import Case, OuterRef, Q, QuerySet, Subquery, When
from django_filters.rest_framework import DjangoFilterBackend
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.api.once import once
from annotations.api.queueing.sending import Sending, SentSerializer, WhatToLookAt
from annotations.api.reading import FiniteField
from annotations.api.routes import RowRoute, RowsRoute, WorldRoute
from annotations.language.corpus import KNOWN, harmonic_mean
from annotations.lists.filtering import Key
from annotations.models import Split
from parser_service.api.runs import OfRun
from parser_service.models import Evaluation, Prediction
from parser_service.results.choices import read_choices, scored_splits
from parser_service.results.export import as_json
from parser_service.slices import PredictionFilters


class EvaluationSerializer(serializers.ModelSerializer):
    """Exact match of a run on one source of one part; fractions of 1, the interval at 95 %. Of a split by form
    ``accuracy`` is that on unseen forms, except of the part ``known``; ``harmonic_mean`` is that of it and of
    ``accuracy_known``. Both are null for other splits and where known forms were not held out."""

    run = serializers.IntegerField(source="run_id")
    accuracy_known = serializers.FloatField(allow_null=True)
    harmonic_mean = serializers.SerializerMethodField()

    class Meta:
        model = Evaluation
        fields = [
            *("id", "run", "part", "test_source", "count", "correct", "accuracy"),
            *("interval_low", "interval_high", "equivalent", "well_formed"),
            *("accuracy_known", "harmonic_mean"),
        ]

    def get_harmonic_mean(self, score: Evaluation) -> float | None:
        known = score.accuracy_known
        return None if known is None else harmonic_mean(score.accuracy, known)


class EvaluationQuery(django_filters.FilterSet):
    run = Key("run_id")
    split = Key("run__split_id")
    parser = django_filters.CharFilter("run__parser")

    class Meta:
        model = Evaluation
        fields = ["part", "test_source"]


class EvaluationNoun:
    model = Evaluation
    serializer_class = EvaluationSerializer

    def rows(self) -> QuerySet[Evaluation]:
        known = Evaluation.objects.filter(
            run=OuterRef("run"), test_source=OuterRef("test_source"), part=KNOWN
        )
        beside_known = When(~Q(part=KNOWN), then=Subquery(known.values("accuracy")))
        return Evaluation.objects.filter(run__world=self.world).annotate(
            accuracy_known=Case(beside_known, default=None)
        )


class Evaluations(EvaluationNoun, RowsRoute):
    """Lists how often runs are right."""

    filterset_class = EvaluationQuery
    sorts = {"id": "pk", "accuracy": "accuracy"}


class OneEvaluation(EvaluationNoun, RowRoute):
    """Shows an evaluation."""


class PredictionSerializer(serializers.ModelSerializer):
    """A ranked candidate of a run for an example, whose ``label`` is the annotated form. ``is_cut``: the
    parser read only the beginning of the utterance."""

    run = serializers.IntegerField(source="run_id")
    example = serializers.IntegerField(source="example_id")
    utterance = serializers.CharField(source="example.utterance")
    label = serializers.CharField(source="example.logical_form")
    score = FiniteField(allow_null=True)

    class Meta:
        model = Prediction
        fields = [
            *("id", "run", "example", "utterance", "label", "rank", "logical_form", "score"),
            *("is_exact_match", "is_equivalent", "is_well_formed"),
            *("answer_in_training", "label_in_training", "origin", "is_cut"),
        ]


class FiltersOfRun(DjangoFilterBackend):
    """Tells the filters whose answers the rows are, which makes some of them quick."""

    def get_filterset_kwargs(self, request: Request, queryset: Any, view: Any) -> dict[str, Any]:
        return {**super().get_filterset_kwargs(request, queryset, view), "of_run": view.run()}


class PredictionQuery(PredictionFilters):
    """The filters of the page. Some have choices that only a world knows, so they are described as texts."""


for name in ("category", "slice", "answer_head", "versus"):
    extend_schema_field(OpenApiTypes.STR)(PredictionQuery.base_filters[name])


class Predictions(OfRun):
    """Lists the first answer of a run to every example, chosen as on the page, or by a saved slice."""

    model = Prediction
    serializer_class = PredictionSerializer
    filter_backends: ClassVar[list[Any]] = [FiltersOfRun]
    filterset_class = PredictionQuery
    sorts = {"example": "example_id", "utterance": "example__utterance"}

    def rows(self) -> QuerySet[Prediction]:
        return self.run().predictions.best().select_related("example")


class SendPredictions(Sending, Predictions):
    """Sends what is behind the answers that the filters choose to the work queue."""

    @extend_schema(request=WhatToLookAt, responses={200: SentSerializer})
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
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


class Results(WorldRoute):
    """Shows what the results page shows, for the parameters of its address: one figure a row."""

    model = Split

    @extend_schema(responses={200: OpenApiTypes.OBJECT})
    def get(self, request: Request, **kwargs: object) -> Response:
        choices = read_choices(request.query_params, self.world, scored_splits(self.world))
        return Response(as_json(self.world, choices, choices.tables(self.world)))
