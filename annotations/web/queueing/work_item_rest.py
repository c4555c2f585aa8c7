"""The work queue: the rows that its pages show, and what a person does with one."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

import django_filters
from django.db.models import Prefetch, prefetch_related_objects
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import OpenApiResponse, extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.exceptions import ValidationError
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.label_audit.label_decisions import end_item
from annotations.labelling.label_answers import AnsweredMeanwhile, NoLongerYours
from annotations.language.errors import LanguageError
from annotations.models import Assignment, Duty, Label, Verdict, WorkItem, WorkKind
from annotations.models.corpus import MOST_CHARACTERS, verdict_choices
from annotations.models.queueing import WorkItemQuerySet, work_kind_choices
from annotations.queueing.enqueuing import ASKABLE, ask_about
from annotations.queueing.finishing import finish, give_back, skip
from annotations.queueing.giving import next_item
from annotations.queueing.item_answers import answer, labels_to_compare
from annotations.web.queueing.work_item_forms import LONGEST_QUESTION
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.problem_details import Conflict, PreconditionRequired, refusal_of_text
from annotations.web.rest.routes import RowRoute, RowsRoute, WorldRoute

PARTS = Prefetch("assignments", Assignment.objects.select_related("person"))
STATES = ("open", "free", "taken", "done")


class AssignmentSerializer(serializers.ModelSerializer):
    person = serializers.CharField(source="person.username", default=None)

    class Meta:
        model = Assignment
        fields = ["person", "outcome", "leased_until", "taken_at", "done_at"]


class WorkSubjectSerializer(serializers.Serializer):
    """What an item is about; ``version`` is that of an utterance."""

    kind = serializers.ChoiceField(choices=["utterance", "template", "paraphrase"])
    id = serializers.IntegerField()
    version = serializers.IntegerField(required=False)


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

    @extend_schema_field(WorkSubjectSerializer)
    def get_subject(self, item: WorkItem) -> dict[str, Any]:
        if item.utterance is not None:
            return {"kind": "utterance", "id": item.utterance_id, "version": item.utterance.version}
        if item.template_id:
            return {"kind": "template", "id": item.template_id}
        return {"kind": "paraphrase", "id": item.paraphrase_id}


class ComparedLabelSerializer(serializers.ModelSerializer):
    annotator = serializers.CharField(source="annotator.username", default=None)

    class Meta:
        model = Label
        fields = ["annotator", "verdict", "form", "reason"]


class ComparedWorkItemSerializer(WorkItemSerializer):
    """An item; ``labels`` are those that an adjudication compares, for who holds it or once it is done."""

    labels = serializers.SerializerMethodField()

    class Meta(WorkItemSerializer.Meta):
        fields = [*WorkItemSerializer.Meta.fields, "labels"]

    @extend_schema_field(ComparedLabelSerializer(many=True))
    def get_labels(self, item: WorkItem) -> Any:
        labels = labels_to_compare(item, self.context["request"].user)
        return ComparedLabelSerializer(labels, many=True).data


class WhatToAsk(Fields):
    """The row that somebody is to look at, and why, as they read it in the queue."""

    kind = serializers.ChoiceField(choices=list(ASKABLE))
    id = serializers.IntegerField(min_value=1, max_value=2**63 - 1)
    reason = LineField(max_length=LONGEST_QUESTION)


class WorkItemQuery(django_filters.FilterSet):
    """Which items to list; all of them where nothing is asked."""

    kind = django_filters.ChoiceFilter(choices=work_kind_choices())
    state = django_filters.ChoiceFilter(
        choices=[(each, each) for each in STATES], method="by_state"
    )

    def by_state(self, rows: WorkItemQuerySet, name: str, value: str) -> WorkItemQuerySet:
        if value == "done":
            return rows.filter(closed_at__isnull=False)
        return {"open": rows.open, "free": rows.free, "taken": rows.taken}[value]()


class AnswerSerializer(Fields):
    """What an utterance means: ``form`` in any notation where the verdict is ``form``. Other subjects
    need nothing. A label in doubt is kept without a verdict, corrected by a form, or excluded.
    ``version`` is that of the utterance when it was read; an answer that decides needs it."""

    verdict = serializers.ChoiceField(choices=verdict_choices(), required=False)
    form = serializers.CharField(required=False, default="", allow_blank=True, max_length=5_000)
    reason = serializers.CharField(
        required=False, default="", allow_blank=True, max_length=MOST_CHARACTERS
    )
    version = serializers.IntegerField(required=False, min_value=0, max_value=2**31 - 1)


class WorkItemNoun:
    model = WorkItem
    serializer_class = WorkItemSerializer

    def rows(self) -> WorkItemQuerySet:
        return self.world.work_items.present().select_related("utterance").prefetch_related(PARTS)


class WorkItems(WorkItemNoun, RowsRoute):
    """Lists the items of the work queue, the oldest first; reviewers ask for a look at a row."""

    filterset_class = WorkItemQuery
    sorts = {"id": "pk", "created": "created_at", "priority": "priority"}
    duties = {"POST": Duty.REVIEW}

    @extend_schema(request=WhatToAsk, responses={201: WorkItemSerializer})
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        sent = self.read(WhatToAsk)
        subject = get_object_or_404(ASKABLE[sent["kind"]](self.world), pk=sent["id"])
        if not ask_about(self.world, subject, sent["reason"], request.user):
            raise Conflict("Somebody is asked about this already.")
        rows = self.rows().filter(**{sent["kind"]: subject, "kind": WorkKind.REQUESTED})
        return RowRoute.show(self, rows.order_by("-pk")[0], HTTPStatus.CREATED)


class OneWorkItem(WorkItemNoun, RowRoute):
    """Shows one item."""

    serializer_class = ComparedWorkItemSerializer


class WorkItemVerb(WorkItemNoun, WorldRoute):
    """What a person does with an item; the queue itself knows who may."""

    def held(self, request: Request, pk: int) -> Assignment:
        """Return the caller's part of an item. Raises Http404 or Conflict."""
        parts = Assignment.objects.held().filter(person=request.user, item__world=self.world)
        part = parts.filter(item=pk).select_related("item__utterance").first()
        if part is None:
            get_object_or_404(self.world.work_items.present(), pk=pk)
            raise Conflict("This is not yours now. POST to next/ to get an item.")
        return part

    def shown(self, pk: int) -> Response:
        return Response(WorkItemSerializer(self.rows().get(pk=pk)).data)


class NextWorkItem(WorkItemVerb):
    """Gives the caller the item they hold, or the most urgent one that is free."""

    @extend_schema(
        operation_id="work_item_next",
        request=None,
        responses={
            200: WorkItemSerializer,
            204: OpenApiResponse(description="There is nothing that the caller can do now."),
        },
    )
    def post(self, request: Request, world: str) -> Response:
        part = next_item(request.user, self.world)
        if part is None:
            return Response(status=204)
        prefetch_related_objects([part.item], PARTS)
        return Response(WorkItemSerializer(part.item).data)


class FinishWorkItem(WorkItemVerb):
    """Ends the caller's part of an item, with a label where it is about an utterance."""

    @extend_schema(
        operation_id="work_item_finish",
        request=AnswerSerializer,
        responses={
            200: WorkItemSerializer,
        },
    )
    def post(self, request: Request, world: str, pk: int) -> Response:
        part = self.held(request, pk)
        sent = self.read(AnswerSerializer)
        try:
            self._finish(part, request, sent)
        except (AnsweredMeanwhile, NoLongerYours) as error:
            raise Conflict(str(error)) from error
        except LanguageError as error:
            raise refusal_of_text(error, "form") from error
        except ValueError as error:
            raise ValidationError({"form": [str(error)]}) from error
        return self.shown(pk)

    def _finish(self, part: Assignment, request: Request, values: dict[str, Any]) -> None:
        if end_item(part, values.get("verdict", ""), values["form"], values["reason"]):
            return
        if part.item.utterance is None:
            finish(part)
            return
        verdict, version = values.pop("verdict", Verdict.FORM), values.pop("version", None)
        if version is None and not part.item.is_for_two and verdict != Verdict.SKIP:
            raise PreconditionRequired(
                "Send the version of the utterance as you read it, so that nobody's answer is overwritten unseen."
            )
        answer(
            part.item.utterance,
            verdict,
            by=request.user,
            version=version or 0,
            assignment=part,
            **values,
        )


class GiveBackWorkItem(WorkItemVerb):
    """Returns an item that the caller holds, for others."""

    @extend_schema(
        operation_id="work_item_give_back",
        request=None,
        responses={200: WorkItemSerializer},
    )
    def post(self, request: Request, world: str, pk: int) -> Response:
        give_back(self.held(request, pk))
        return self.shown(pk)


class SkipWorkItem(WorkItemVerb):
    """Returns an item that the caller holds; they do not get it again."""

    @extend_schema(
        operation_id="work_item_skip",
        request=None,
        responses={200: WorkItemSerializer},
    )
    def post(self, request: Request, world: str, pk: int) -> Response:
        skip(self.held(request, pk))
        return self.shown(pk)
