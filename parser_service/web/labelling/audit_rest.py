"""Label audits: started, and how often they were right."""

from __future__ import annotations

from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.models import AuditFinding, Duty, JobKind
from annotations.web.rest.form_fields import FormFields
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import WorldRoute
from annotations.web.worlds.job_rest import JobSerializer, accepted
from parser_service.labelling.audit_job import request_audit
from parser_service.labelling.precision import precision_of
from parser_service.web.labelling.audit_forms import AuditForm


class NewAudit(FormFields):
    """What answers for pairs that it did not see, in how many parts, and how many labels people are asked
    about."""

    class Meta:
        form = AuditForm
        fields = ("parser", "folds", "to_queue")
        begins = True


class PrecisionSerializer(serializers.Serializer[Any]):
    """What became of the labels that people have looked at; ``share`` of them were wrong, a fraction of 1
    with its 95 % interval."""

    kept = serializers.IntegerField()
    corrected = serializers.IntegerField()
    excluded = serializers.IntegerField()
    share = serializers.FloatField()
    interval = serializers.ListField(child=serializers.FloatField(), min_length=2, max_length=2)


class AuditSerializer(serializers.Serializer[Any]):
    """The last audit, and how right audits were; null before the first one, and the first decision."""

    job = JobSerializer(allow_null=True)
    precision = PrecisionSerializer(allow_null=True)


class LabelAudit(WorldRoute):
    """Shows how far the last label audit is, and starts one; what it finds is in ``audit-findings/``."""

    model = AuditFinding
    filter_backends = []
    duties = {"POST": Duty.REVIEW}

    @extend_schema(operation_id="audit", responses={200: AuditSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        job = self.world.jobs.filter(kind=JobKind.AUDIT).select_related("created_by").first()
        precision = precision_of(self.world)
        shown = {
            "job": JobSerializer(job).data if job else None,
            "precision": PrecisionSerializer(precision).data if precision else None,
        }
        return Response(shown)

    @extend_schema(operation_id="start_audit", request=NewAudit, responses={202: JobSerializer})
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        form = AuditForm(self.read(NewAudit))
        if not form.is_valid():
            raise refusal_of_form(form)
        job = request_audit(self.world, request.user, form.cleaned_data)
        return accepted(request, job)
