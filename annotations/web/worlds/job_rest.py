"""Routes of background jobs."""

from __future__ import annotations

from http import HTTPStatus

import django_filters
from django.db.models import QuerySet
from django.http import FileResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.exceptions import NotFound
from rest_framework.response import Response

from annotations.background.job_files import result_of
from annotations.background.requesting import answer_job, cancel_job
from annotations.language.texts import Refusal
from annotations.models import Duty, Job, World
from annotations.people.allowances import may_take_long
from annotations.web.rest.fields import Fields
from annotations.web.rest.negotiation import AnyType
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import Retrieved, RowsViewSet, SiteViewSet, Tagged
from annotations.web.rest.streaming import JSON_LINES


class JobSerializer(serializers.ModelSerializer[Job]):
    """A background job, such as an import. ``report`` is its result, null until it has ended, and
    ``seconds_left`` an estimate by the progress of a running one, null where that says nothing yet.

    A job that ``is_waiting_for_answer`` would remove something, or has checked crowd results: POST to ``answer/``
    to allow what the report says, or to ``cancel/`` to drop the job.
    """

    report = serializers.DictField(allow_null=True)
    created_by = serializers.CharField(source="created_by.username", default=None)
    is_waiting_for_answer = serializers.BooleanField()
    seconds_left = serializers.FloatField(read_only=True, allow_null=True)

    class Meta:
        model = Job
        fields = [
            *("id", "kind", "status", "progress", "activity", "seconds_left"),
            *("failure", "report"),
            *("is_waiting_for_answer", "cancel_requested", "created_by"),
            *("queued_at", "started_at", "finished_at"),
        ]


def address_of_job(request: ApiRequest, job: Job) -> str:
    """Return the address at which the caller follows a job: below its world, where there is one."""
    world = job.world if job.world and job.world.deletion_requested_at is None else None
    below = f"worlds/{world.name}/jobs" if world else "jobs"
    return request.build_absolute_uri(f"/api/v1/{below}/{job.pk}/")


def accepted(request: ApiRequest, job: Job) -> Response:
    """Answer with a job that was asked for, and where it is."""
    location = {"Location": address_of_job(request, job)}
    return Response(JobSerializer(job).data, status=HTTPStatus.ACCEPTED, headers=location)


class JobQuery(django_filters.FilterSet):
    class Meta:
        model = Job
        fields = ["kind", "status"]


class AnswerRequest(Fields):
    """``arena`` is one of those that the report of the job offers, if it does."""

    arena = serializers.CharField(required=False, max_length=60)


class Cancelling(Tagged):
    """Stops a job, or says why it cannot be stopped."""

    @extend_schema(request=None, responses={200: JobSerializer})
    @action(detail=True, methods=["post"])
    def cancel(self, request: ApiRequest, **kwargs: object) -> Response:
        """Stops a job within seconds, or drops an import that asks."""
        cancel_job(self.get_object())
        return self.show(self.get_object())


class JobViewSet(Cancelling, RowsViewSet):
    """The jobs of a world, the newest first: how far one is, or what came of it."""

    model = Job
    serializer_class = JobSerializer
    filterset_class = JobQuery
    sorts = {"newest": "-id", "status": "status"}

    @property
    def duty(self) -> Duty:
        """Return the duty that the request needs; to cancel or answer a job, the duty for starting it."""
        if self.action not in ("cancel", "answer"):
            return super().duty
        keys = {"world__name": self.kwargs["world"], "pk": self.kwargs["pk"]}
        job = Job.objects.filter(**keys).first()
        return job.duty if job else Duty.VIEW

    def rows(self) -> QuerySet[Job]:
        return self.world.jobs.select_related("created_by")

    @extend_schema(responses={(200, JSON_LINES): OpenApiTypes.STR})
    @may_take_long
    @action(detail=True, content_negotiation_class=AnyType)
    def result(self, request: ApiRequest, **kwargs: object) -> FileResponse:
        """Downloads the file that a job has made. It is kept for seven days."""
        job = self.get_object()
        if not job.is_ended:
            raise Refusal(
                f"Job {job.pk} is {job.status}: its file is there once its status is succeeded. Ask again then.",
                "job_not_ended",
                HTTPStatus.CONFLICT,
            )
        try:
            file = result_of(job).open("rb")
        except FileNotFoundError as error:
            raise NotFound(
                f"Job {job.pk} ({job.status}) has made no file, or has made it more than a week ago."
            ) from error
        name = f"{self.world.name}-job-{job.pk}.jsonl"
        return FileResponse(file, as_attachment=True, filename=name, content_type=JSON_LINES)

    @extend_schema(request=AnswerRequest, responses={202: JobSerializer})
    @action(detail=True, methods=["post"])
    def answer(self, request: ApiRequest, **kwargs: object) -> Response:
        """Imports the kept files after all, as the report says."""
        job, sent = self.get_object(), self.read(AnswerRequest)
        answered = answer_job(job, request.user, sent.get("arena", ""))
        return self.show(answered, HTTPStatus.ACCEPTED)


class SiteJobViewSet(Cancelling, Retrieved, SiteViewSet):
    """Jobs whose world nobody sees: its import has not ended, or its deletion has begun."""

    model = Job
    serializer_class = JobSerializer

    duties = {"cancel": Duty.MANAGE}

    def rows(self) -> QuerySet[Job]:
        user = self.request.user
        rows = Job.objects.visible_to(user).select_related("created_by", "world")
        seen = World.objects.visible_to(user)
        if self.action == "cancel":
            return rows.exclude(world__in=World.objects.present())
        return rows.exclude(world__in=World.objects.present().exclude(pk__in=seen.values("pk")))
