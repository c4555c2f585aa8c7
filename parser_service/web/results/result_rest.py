"""How often runs are right: each evaluation, and the tables of the results page."""

from __future__ import annotations

from typing import Any

import django_filters
from django.db.models import Case, OuterRef, Q, QuerySet, Subquery, When
from django.http import HttpResponse
from django.shortcuts import get_object_or_404
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.response import Response

from annotations.language.corpus import KNOWN, harmonic_mean
from annotations.models import Duty, Split
from annotations.showing.filtering import Key
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.negotiation import AnyType
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import RowsViewSet, WorldRoute
from annotations.web.worlds.job_rest import JobSerializer, accepted
from parser_service.models import Evaluation
from parser_service.results.export import ResultsFormat
from parser_service.results.measures import Measure, interval_of, is_known
from parser_service.results.measuring_job import request_measurement
from parser_service.web.results.result_files import results_file

IntervalField = serializers.ListField(child=serializers.FloatField(), min_length=2, max_length=2)
MaybeIntervalField = serializers.ListField(
    child=serializers.FloatField(), min_length=2, max_length=2, allow_null=True
)


class EvaluationSerializer(serializers.ModelSerializer[Evaluation]):
    """Exact match of a run on one source of one part; fractions of 1, the interval at 95 %. On a split by
    form ``accuracy`` is that on unseen forms, except for the part ``known``; ``harmonic_mean`` combines it
    with ``accuracy_known``. Both are null for other splits, and if known forms were not held out. ``same_plan`` and
    its interval are null where plans were not compared. Intervals are low and high."""

    run = serializers.IntegerField(source="run_id")
    accuracy_known = serializers.FloatField(allow_null=True)
    harmonic_mean = serializers.SerializerMethodField()
    equivalent_interval = serializers.SerializerMethodField()
    same_plan_interval = serializers.SerializerMethodField()

    class Meta:
        model = Evaluation
        fields = [
            *("id", "run", "part", "test_source", "count", "correct", "accuracy"),
            *("interval_low", "interval_high", "equivalent", "well_formed", "same_plan"),
            *("equivalent_interval", "same_plan_interval", "accuracy_known", "harmonic_mean"),
        ]

    def get_harmonic_mean(self, score: Any) -> float | None:
        known = score.accuracy_known
        return None if known is None else harmonic_mean(score.accuracy, known)

    @extend_schema_field(IntervalField)
    def get_equivalent_interval(self, score: Evaluation) -> tuple[float, float]:
        return interval_of(score, Measure.EQUIVALENT)

    @extend_schema_field(MaybeIntervalField)
    def get_same_plan_interval(self, score: Evaluation) -> tuple[float, float] | None:
        is_compared = is_known(score, Measure.SAME_PLAN)
        return interval_of(score, Measure.SAME_PLAN) if is_compared else None


class EvaluationQuery(django_filters.FilterSet):
    run = Key("run_id")
    split = Key("run__split_id")
    parser = django_filters.CharFilter("run__parser")

    class Meta:
        model = Evaluation
        fields = ["part", "test_source"]


class EvaluationViewSet(RowsViewSet):
    """How often runs are right."""

    model = Evaluation
    serializer_class = EvaluationSerializer
    filterset_class = EvaluationQuery
    sorts = {"id": "pk", "accuracy": "accuracy"}

    def rows(self) -> QuerySet[Evaluation]:
        known = Evaluation.objects.filter(
            run=OuterRef("run"), test_source=OuterRef("test_source"), part=KNOWN
        )
        beside_known = When(~Q(part=KNOWN), then=Subquery(known.values("accuracy")))
        return Evaluation.objects.filter(run__world=self.world).annotate(
            accuracy_known=Case(beside_known, default=None)
        )


class NewMeasurement(Fields):
    """The split to measure on; by default the one that says most about the parsers of the world."""

    split = serializers.IntegerField(required=False, min_value=1, max_value=2**31)


class Measurement(WorldRoute):
    """Starts to measure what a robot gets from the answerer of the world; what comes of it is in ``results/``."""

    model = Split
    filter_backends = []
    duties = {"POST": Duty.REVIEW}

    @extend_schema(request=NewMeasurement, responses={202: JobSerializer})
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        key = self.read(NewMeasurement).get("split")
        split = get_object_or_404(self.world.splits, pk=key) if key else None
        job = request_measurement(self.world, request.user, split)
        return accepted(request, job)


class ResultsQuery(serializers.Serializer[Any]):
    """What may be asked of the results, beside what the address of their page has."""

    format = serializers.ChoiceField(choices=[*ResultsFormat], default=ResultsFormat.JSON)


class Results(WorldRoute):
    """Shows what the results page shows, for the parameters of its address: one figure a row."""

    model = Split
    content_negotiation_class = AnyType

    @extend_schema(
        parameters=[ResultsQuery],
        responses={
            (200, "application/json"): OpenApiTypes.OBJECT,
            (200, "text/csv"): OpenApiTypes.STR,
            (200, "application/vnd.apache.parquet"): OpenApiTypes.BINARY,
            (200, "application/x-tex"): OpenApiTypes.STR,
        },
    )
    def get(self, request: ApiRequest, **kwargs: object) -> HttpResponse:
        query = ResultsQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        return results_file(self.world, request.query_params, query.validated_data["format"])
