"""The findings of label audits: the rows that the page shows."""

from __future__ import annotations

from typing import Any

import django_filters
from drf_spectacular.utils import extend_schema_field
from rest_framework import serializers

from annotations.api.routes import RowRoute, RowsRoute
from annotations.models import AuditDecision, AuditFinding, AuditReason
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


class FindingSubjectSerializer(serializers.Serializer):
    kind = serializers.ChoiceField(choices=["utterance", "paraphrase"])
    id = serializers.IntegerField()


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

    @extend_schema_field(FindingSubjectSerializer)
    def get_subject(self, finding: AuditFinding) -> dict[str, Any]:
        if finding.utterance_id:
            return {"kind": "utterance", "id": finding.utterance_id}
        return {"kind": "paraphrase", "id": finding.paraphrase_id}


class AuditFindingQuery(django_filters.FilterSet):
    """Which findings to list; all of them where nothing is asked."""

    status = django_filters.ChoiceFilter(choices=finding_status_choices(), method="by_status")
    reason = django_filters.ChoiceFilter(choices=audit_reason_choices(), method="by_reason")

    def by_status(self, rows: AuditFindingQuerySet, name: str, value: str) -> AuditFindingQuerySet:
        return rows.with_status(value)

    def by_reason(self, rows: AuditFindingQuerySet, name: str, value: str) -> AuditFindingQuerySet:
        return rows.with_reason(value)


class AuditFindingNoun:
    model = AuditFinding
    serializer_class = AuditFindingSerializer

    def rows(self) -> AuditFindingQuerySet:
        return self.world.audit_findings.prefetch_related("reasons", "decisions__decided_by")


class AuditFindings(AuditFindingNoun, RowsRoute):
    """Lists the labels that audits have found to be in doubt, the most suspect first."""

    filterset_class = AuditFindingQuery
    sorts = {"rank": "rank", "id": "pk"}


class OneAuditFinding(AuditFindingNoun, RowRoute):
    """Shows one finding."""
