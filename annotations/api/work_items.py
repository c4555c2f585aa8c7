"""The work queue over the API: the rows that its pages show, and what a person does with one."""

from __future__ import annotations

from typing import Any

from django.db.models import Prefetch, prefetch_related_objects
from django.shortcuts import get_object_or_404
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiResponse, extend_schema, extend_schema_field
from rest_framework import serializers, status
from rest_framework.exceptions import APIException, ValidationError
from rest_framework.pagination import CursorPagination
from rest_framework.request import Request
from rest_framework.response import Response
from rest_framework.views import APIView

from annotations.api.permissions import HasDuty
from annotations.auditing import end_item
from annotations.labelling import AnsweredMeanwhile
from annotations.language.errors import LanguageError
from annotations.models import Assignment, Duty, Verdict, WorkItem, World
from annotations.models.utterances import MOST_CHARACTERS, verdict_choices
from annotations.models.work_items import WorkItemQuerySet, work_kind_choices
from annotations.queueing import NoLongerYours, answer, finish, give_back, next_item

PARTS = Prefetch("assignments", Assignment.objects.select_related("person"))
STATES = ("open", "free", "taken", "done")


class Conflict(APIException):
    status_code = status.HTTP_409_CONFLICT
    default_code = "conflict"


class AssignmentSerializer(serializers.ModelSerializer):
    person = serializers.CharField(source="person.username", default=None)

    class Meta:
        model = Assignment
        fields = ["person", "outcome", "leased_until", "taken_at", "done_at"]


class WorkItemSerializer(serializers.ModelSerializer):
    """An item with the people who have it or had it; what they answered is not shown."""

    subject = serializers.SerializerMethodField()
    assignments = AssignmentSerializer(many=True)

    class Meta:
        model = WorkItem
        fields = [
            *("id", "kind", "reason", "title", "subject", "priority", "people", "places"),
            *("created_at", "closed_at", "assignments"),
        ]

    @extend_schema_field({"type": "object", "properties": {"kind": {}, "id": {}, "version": {}}})
    def get_subject(self, item: WorkItem) -> dict[str, Any]:
        if item.utterance is not None:
            return {"kind": "utterance", "id": item.utterance_id, "version": item.utterance.version}
        if item.template_id:
            return {"kind": "template", "id": item.template_id}
        return {"kind": "paraphrase", "id": item.paraphrase_id}


class WorkItemQuery(serializers.Serializer):
    """Which items to list; all of them where nothing is asked."""

    kind = serializers.ChoiceField(choices=work_kind_choices(), required=False)
    state = serializers.ChoiceField(choices=[(each, each) for each in STATES], required=False)


class AnswerSerializer(serializers.Serializer):
    """What an utterance means: ``form`` in any notation where the verdict is ``form``. Other subjects
    need nothing. A label in doubt is kept without a verdict, corrected by a form, or excluded.
    ``version`` is that of the utterance when it was read."""

    verdict = serializers.ChoiceField(choices=verdict_choices(), required=False)
    form = serializers.CharField(required=False, default="", allow_blank=True, max_length=5_000)
    reason = serializers.CharField(
        required=False, default="", allow_blank=True, max_length=MOST_CHARACTERS
    )
    version = serializers.IntegerField(required=False, default=0, min_value=0, max_value=2**31 - 1)


class Pages(CursorPagination):
    page_size = 100
    ordering = "id"


class WorkItemRoute(APIView):
    """What the routes share: who may, and the rows of the world."""

    permission_classes = [HasDuty]
    duty = Duty.VIEW
    world: World

    def rows(self) -> WorkItemQuerySet:
        return self.world.work_items.select_related("utterance").prefetch_related(PARTS)

    def held(self, request: Request, pk: int) -> Assignment:
        """Return the caller's part of an item. Raises Http404 or Conflict."""
        parts = Assignment.objects.held().filter(person=request.user, item__world=self.world)
        part = parts.filter(item=pk).select_related("item__utterance").first()
        if part is None:
            get_object_or_404(self.world.work_items, pk=pk)
            raise Conflict("This is not yours now. POST to next/ to get an item.")
        return part

    def shown(self, pk: int) -> Response:
        return Response(WorkItemSerializer(self.rows().get(pk=pk)).data)


REFUSALS = {
    401: OpenApiResponse(description="No token, or one that is not valid."),
    404: OpenApiResponse(description="No such item in a world that you can see."),
}
CLASH = {409: OpenApiResponse(description="Somebody else has it, or has changed the utterance.")}


class WorkItems(WorkItemRoute):
    """Lists the items of the work queue, the oldest first."""

    @extend_schema(
        operation_id="work_items",
        parameters=[WorkItemQuery],
        responses={200: WorkItemSerializer(many=True), **REFUSALS},
    )
    def get(self, request: Request, world: str) -> Response:
        query = WorkItemQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        rows = self.rows()
        if kind := query.validated_data.get("kind"):
            rows = rows.filter(kind=kind)
        state = query.validated_data.get("state")
        if state == "done":
            rows = rows.filter(closed_at__isnull=False)
        elif state:
            rows = getattr(rows, state)()
        pages = Pages()
        page = pages.paginate_queryset(rows, request, view=self)
        return pages.get_paginated_response(WorkItemSerializer(page, many=True).data)


class OneWorkItem(WorkItemRoute):
    """Shows one item."""

    @extend_schema(operation_id="work_item", responses={200: WorkItemSerializer, **REFUSALS})
    def get(self, request: Request, world: str, pk: int) -> Response:
        get_object_or_404(self.rows(), pk=pk)
        return self.shown(pk)


class NextWorkItem(WorkItemRoute):
    """Gives the caller the item they hold, or the most urgent one that is free."""

    @extend_schema(
        operation_id="work_item_next",
        request=None,
        responses={
            200: WorkItemSerializer,
            204: OpenApiResponse(description="There is nothing that the caller can do now."),
            **REFUSALS,
        },
    )
    def post(self, request: Request, world: str) -> Response:
        part = next_item(request.user, self.world)
        if part is None:
            return Response(status=204)
        prefetch_related_objects([part.item], PARTS)
        return Response(WorkItemSerializer(part.item).data)


class FinishWorkItem(WorkItemRoute):
    """Ends the caller's part of an item, with a label where it is about an utterance."""

    @extend_schema(
        operation_id="work_item_finish",
        request=AnswerSerializer,
        responses={
            200: WorkItemSerializer,
            400: OpenApiTypes.OBJECT,
            **CLASH,
            **REFUSALS,
        },
    )
    def post(self, request: Request, world: str, pk: int) -> Response:
        sent = AnswerSerializer(data=request.data)
        sent.is_valid(raise_exception=True)
        part = self.held(request, pk)
        try:
            self._finish(part, request, dict(sent.validated_data))
        except (AnsweredMeanwhile, NoLongerYours) as error:
            raise Conflict(str(error)) from error
        except (LanguageError, ValueError) as error:
            raise ValidationError({"form": [str(error)]}) from error
        return self.shown(pk)

    def _finish(self, part: Assignment, request: Request, values: dict[str, Any]) -> None:
        if end_item(part, values.get("verdict", ""), values["form"], values["reason"]):
            return
        if part.item.utterance is None:
            finish(part)
            return
        verdict = values.pop("verdict", Verdict.FORM)
        answer(part.item.utterance, verdict, by=request.user, part=part, **values)


class GiveBackWorkItem(WorkItemRoute):
    """Returns an item that the caller holds, for others."""

    @extend_schema(
        operation_id="work_item_give_back",
        request=None,
        responses={200: WorkItemSerializer, **CLASH, **REFUSALS},
    )
    def post(self, request: Request, world: str, pk: int) -> Response:
        give_back(self.held(request, pk))
        return self.shown(pk)
