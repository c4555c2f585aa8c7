"""How well people agree, and how much everybody has done."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.labelling.agreeing import report_agreement
from annotations.labelling.queue_progress import progress_of
from annotations.models import Assignment
from annotations.web.rest.fields import FiniteField
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import Figures


class EstimateSerializer(serializers.Serializer[Any]):
    """A coefficient with its 95 % interval; null where the answers do not define it, as ``meaning`` says."""

    value = FiniteField(allow_null=True)
    interval = serializers.ListField(child=FiniteField(), allow_null=True)
    meaning = serializers.CharField()


class AgreementSerializer(serializers.Serializer[Any]):
    """How two people agree on ``items``: exact match, Krippendorff's α, Gwet's AC1."""

    items = serializers.IntegerField()
    exact_match = EstimateSerializer()
    alpha = EstimateSerializer()
    ac1 = EstimateSerializer()


class AgreementOfSlice(serializers.Serializer[Any]):
    name = serializers.CharField()
    agreement = AgreementSerializer()


class DisagreementSerializer(serializers.Serializer[Any]):
    """Two answers to the same utterances, such as ``example``."""

    first = serializers.CharField()
    second = serializers.CharField()
    count = serializers.IntegerField()
    example = serializers.CharField()


class AgreementReportSerializer(serializers.Serializer[Any]):
    """Agreement on everything that two people have labelled, by task category and by head predicate.

    ``is_capped`` where only the newest items were looked at.
    """

    overall = AgreementSerializer()
    by_category = AgreementOfSlice(many=True)
    by_head = AgreementOfSlice(many=True)
    disagreements = DisagreementSerializer(many=True)
    is_capped = serializers.BooleanField()


class AgreementOfWorld(Figures):
    """Shows how well people agree, and what they differ in."""

    model = Assignment

    @extend_schema(operation_id="agreement", responses={200: AgreementReportSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        return Response(AgreementReportSerializer(asdict(report_agreement(self.world))).data)


class PersonProgressSerializer(serializers.Serializer[Any]):
    """Items that somebody has done; ``days`` go with those of the answer."""

    person = serializers.CharField()
    days = serializers.ListField(child=serializers.IntegerField())
    total = serializers.IntegerField()


class ProgressSerializer(serializers.Serializer[Any]):
    """The last days. They begin with the first day of work among them."""

    days = serializers.ListField(child=serializers.DateField())
    people = PersonProgressSerializer(many=True)
    total = serializers.IntegerField()


class ProgressOfWorld(Figures):
    """Shows how many items of the work queue each person has done, day by day."""

    model = Assignment

    @extend_schema(operation_id="progress", responses={200: ProgressSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        return Response(ProgressSerializer(progress_of(self.world)).data)
