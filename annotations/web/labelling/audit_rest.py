"""The findings of label audits: the rows that the page shows, and what people decide about them."""

from __future__ import annotations

from typing import Any

import django_filters
from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.labelling.label_decisions import decide, take_back_decision
from annotations.language.texts import MAX_FORM, LanguageError
from annotations.models import AuditDecision, AuditFinding, AuditReason, World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.models.queueing import (
    AuditFindingQuerySet,
    audit_reason_choices,
    decision_choices,
    finding_status_choices,
)
from annotations.web.rest.fields import Fields
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_text
from annotations.web.rest.routes import RowsViewSet, WorldViewSet


class AuditReasonSerializer(serializers.ModelSerializer[AuditReason]):
    class Meta:
        model = AuditReason
        fields = ["reason", "sentence", "suggested_form", "score"]


class AuditDecisionSerializer(serializers.ModelSerializer[AuditDecision]):
    decided_by = serializers.CharField(source="decided_by.username", default=None)

    class Meta:
        model = AuditDecision
        fields = ["id", "decision", "form", "reason", "decided_by", "decided_at", "taken_back_at"]


class FindingSubjectSerializer(serializers.Serializer[Any]):
    kind = serializers.ChoiceField(choices=["utterance", "paraphrase"])
    id = serializers.IntegerField()


class AuditFindingSerializer(serializers.ModelSerializer[AuditFinding]):
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


class NewDecision(Fields):
    """What to do with the label: ``kept``, ``corrected`` by a form (the suggested one where it is empty), or
    ``excluded`` from new splits."""

    decision = serializers.ChoiceField(choices=decision_choices())
    form = serializers.CharField(max_length=MAX_FORM, allow_blank=True, default="")
    reason = serializers.CharField(max_length=MOST_CHARACTERS, allow_blank=True, default="")


def finding_rows(world: World) -> AuditFindingQuerySet:
    """Return the findings of a world with what is shown of them."""
    return world.audit_findings.prefetch_related("reasons", "decisions__decided_by")


class AuditFindingViewSet(RowsViewSet):
    """The labels that audits have found to be in doubt, the most suspect first."""

    model = AuditFinding
    serializer_class = AuditFindingSerializer
    filterset_class = AuditFindingQuery
    sorts = {"rank": "rank", "id": "pk"}

    def rows(self) -> AuditFindingQuerySet:
        return finding_rows(self.world)

    @extend_schema(request=NewDecision, responses={200: AuditFindingSerializer})
    @action(detail=True, methods=["post"])
    def decide(self, request: ApiRequest, **kwargs: object) -> Response:
        """Decides about a label in doubt, once. The work queue knows who may."""
        row, sent = self.get_object(), self.read(NewDecision)
        try:
            decide(row, sent["decision"], request.user, sent["form"], sent["reason"])
        except LanguageError as error:
            raise refusal_of_text(error, "form") from error
        return self.show(self.get_object())


class AuditDecisionViewSet(WorldViewSet):
    """Decisions about labels in doubt."""

    model = AuditDecision
    serializer_class = AuditFindingSerializer

    def rows(self) -> QuerySet[AuditDecision]:
        return AuditDecision.objects.filter(finding__world=self.world)

    @extend_schema(request=None, responses={200: AuditFindingSerializer})
    @action(detail=True, methods=["post"], url_path="take-back")
    def take_back(self, request: ApiRequest, **kwargs: object) -> Response:
        """Undoes a decision of the caller; its label is in doubt again."""
        finding = take_back_decision(self.get_object(), request.user)
        return self.show(finding_rows(self.world).get(pk=finding.pk))
