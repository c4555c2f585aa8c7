"""The findings of label audits over the API: the rows that the page shows."""

from __future__ import annotations

from typing import Any

from django.shortcuts import get_object_or_404
from drf_spectacular.utils import OpenApiResponse, extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.pagination import CursorPagination
from rest_framework.request import Request
from rest_framework.response import Response
from rest_framework.views import APIView

from annotations.api.permissions import HasDuty
from annotations.models import AuditDecision, AuditFinding, AuditReason, Duty, World
from annotations.models.audit import (
    AuditFindingQuerySet,
    audit_reason_choices,
    finding_status_choices,
)


class AuditReasonSerializer(serializers.ModelSerializer):
    class Meta:
        model = AuditReason
        fields = ["reason", "sentence", "suggested_form", "score"]


class AuditDecisionSerializer(serializers.ModelSerializer):
    decided_by = serializers.CharField(source="decided_by.username", default=None)

    class Meta:
        model = AuditDecision
        fields = ["decision", "form", "reason", "decided_by", "decided_at", "taken_back_at"]


class AuditFindingSerializer(serializers.ModelSerializer):
    """A label that may be wrong, what speaks against it, and every decision about it."""

    subject = serializers.SerializerMethodField()
    reasons = AuditReasonSerializer(many=True)
    decisions = AuditDecisionSerializer(many=True)

    class Meta:
        model = AuditFinding
        fields = [
            *("id", "subject", "rank", "score", "status", "text", "anonymized_text"),
            *("source_command", "form", "suggested_form", "decided_form", "found_at"),
            *("reasons", "decisions"),
        ]

    @extend_schema_field({"type": "object", "properties": {"kind": {}, "id": {}}})
    def get_subject(self, finding: AuditFinding) -> dict[str, Any]:
        if finding.utterance_id:
            return {"kind": "utterance", "id": finding.utterance_id}
        return {"kind": "paraphrase", "id": finding.paraphrase_id}


class AuditFindingQuery(serializers.Serializer):
    """Which findings to list; all of them where nothing is asked."""

    status = serializers.ChoiceField(choices=finding_status_choices(), required=False)
    reason = serializers.ChoiceField(choices=audit_reason_choices(), required=False)


class Pages(CursorPagination):
    page_size = 100
    ordering = ("rank", "id")


class AuditRoute(APIView):
    """What the routes share: who may, and the rows of the world."""

    permission_classes = [HasDuty]
    duty = Duty.VIEW
    world: World

    def rows(self) -> AuditFindingQuerySet:
        return self.world.audit_findings.prefetch_related("reasons", "decisions__decided_by")


REFUSALS = {
    401: OpenApiResponse(description="No token, or one that is not valid."),
    404: OpenApiResponse(description="No such finding in a world that you can see."),
}


class AuditFindings(AuditRoute):
    """Lists the labels that audits have found to be in doubt, the most suspect first."""

    @extend_schema(
        operation_id="audit_findings",
        parameters=[AuditFindingQuery],
        responses={200: AuditFindingSerializer(many=True), **REFUSALS},
    )
    def get(self, request: Request, world: str) -> Response:
        query = AuditFindingQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        rows = self.rows()
        if status := query.validated_data.get("status"):
            rows = rows.with_status(status)
        if reason := query.validated_data.get("reason"):
            rows = rows.with_reason(reason)
        pages = Pages()
        page = pages.paginate_queryset(rows, request, view=self)
        return pages.get_paginated_response(AuditFindingSerializer(page, many=True).data)


class OneAuditFinding(AuditRoute):
    """Shows one finding."""

    @extend_schema(
        operation_id="audit_finding", responses={200: AuditFindingSerializer, **REFUSALS}
    )
    def get(self, request: Request, world: str, pk: int) -> Response:
        return Response(AuditFindingSerializer(get_object_or_404(self.rows(), pk=pk)).data)
