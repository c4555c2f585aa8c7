"""What error analyses of a run have found, and what it answers to texts beyond its split."""

from __future__ import annotations

from typing import Any

from django.db.models import OuterRef, QuerySet, Subquery
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.exceptions import ValidationError
from rest_framework.response import Response

from annotations.web.rest.fields import FiniteField
from annotations.web.rest.permissions import ApiRequest
from annotations.web.worlds.job_rest import JobSerializer
from parser_service.models import Probe, RunAnalysis
from parser_service.reviews.state import analysis_of
from parser_service.reviews.stored_findings import findings_of
from parser_service.reviews.target import parts_of
from parser_service.web.results.probe_filters import ProbeFilters
from parser_service.web.runs.run_rest import OfRun


class FindingsSerializer(serializers.Serializer[Any]):
    """What is known of ``part`` by name of the analysis: forms that attract unlike inputs, what refusing to
    answer saves, flip rates by kind of edit, deciding words. ``job`` is the last analysis."""

    part = serializers.CharField(allow_blank=True)
    parts = serializers.ListField(child=serializers.CharField())
    is_complete = serializers.BooleanField()
    made_at = serializers.DateTimeField(allow_null=True)
    job = JobSerializer(allow_null=True)
    findings = serializers.DictField()


class RunFindings(OfRun):
    """Shows what the analysis of a run has found; a POST to ``analysis/`` asks for it."""

    model = RunAnalysis
    filter_backends = []
    pagination_class = None

    @extend_schema(
        operation_id="run_findings",
        parameters=[
            OpenApiParameter("part", OpenApiTypes.STR, description="The first one if none.")
        ],
        responses={200: FindingsSerializer},
    )
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        run = self.run()
        parts = parts_of(run)
        part = request.query_params.get("part") or next(iter(parts), "")
        if part and part not in parts:
            raise ValidationError({"part": [f"There is: {', '.join(parts) or 'none'}."]})
        state = analysis_of(run)
        answer = {
            **{"part": part, "parts": parts, "is_complete": state.is_complete},
            **{"made_at": state.made_at, "job": state.job},
            "findings": findings_of(run, part) if part else {},
        }
        return Response(FindingsSerializer(answer).data)


class ProbeSerializer(serializers.ModelSerializer[Probe]):
    """A text outside the split. An edit was made from the utterance ``base``, and ``before`` is the answer to
    that. ``is_expected`` is null where no answer is expected."""

    base = serializers.IntegerField(source="base_id", allow_null=True)
    before = serializers.CharField(allow_null=True)
    answer = serializers.CharField(source="answer.logical_form")
    score = FiniteField(source="answer.score", allow_null=True)
    is_expected = serializers.BooleanField(source="answer.is_expected", allow_null=True)

    class Meta:
        model = Probe
        fields = [
            *("id", "kind", "utterance", "base", "old", "new", "expectation", "expected_form"),
            *("before", "answer", "score", "is_expected"),
        ]


class RunProbes(OfRun):
    """Lists what a run answers to texts beyond its split."""

    model = Probe
    serializer_class = ProbeSerializer
    filterset_class = ProbeFilters
    sorts = {"position": "position"}

    def rows(self) -> QuerySet[Probe]:
        run = self.run()
        first = run.predictions.best().filter(example=OuterRef("base")).values("logical_form")[:1]
        rows = run.probes.filter(answer__isnull=False).select_related("answer")
        return rows.annotate(before=Subquery(first))
