"""The work queue: the rows that its pages show, and what a person does with one."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

import django_filters
from django.db.models import Prefetch, prefetch_related_objects
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import OpenApiResponse, extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.labelling.enqueuing import ASKABLE, ask_about
from annotations.labelling.finishing import finish, give_back, skip
from annotations.labelling.giving import assign, assign_first, next_item, take, withdraw
from annotations.labelling.item_answers import answer, labels_to_compare
from annotations.labelling.label_decisions import end_item
from annotations.language.texts import LanguageError, Refusal
from annotations.models import Assignment, Duty, Label, User, Verdict, WorkItem, WorkKind, World
from annotations.models.corpus import MOST_CHARACTERS, verdict_choices
from annotations.models.queueing import WorkItemQuerySet, work_kind_choices
from annotations.people.members import find_account
from annotations.web.forms import row_field
from annotations.web.labelling.queueing_filters import WorkItemFilters
from annotations.web.labelling.work_item_forms import LONGEST_QUESTION, MOST_ASSIGNED, AssignForm
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import PreconditionRequired, refusal_of_text
from annotations.web.rest.routes import RowsViewSet

PARTS = Prefetch("assignments", Assignment.objects.select_related("person"))
STATES = ("open", "free", "taken", "done")


class AssignmentSerializer(serializers.ModelSerializer[Assignment]):
    person = serializers.CharField(source="person.username", default=None)

    class Meta:
        model = Assignment
        fields = ["person", "outcome", "leased_until", "taken_at", "done_at"]


class WorkSubjectSerializer(serializers.Serializer[Any]):
    """What an item is about; ``version`` is that of an utterance."""

    kind = serializers.ChoiceField(choices=["utterance", "template", "paraphrase"])
    id = serializers.IntegerField()
    version = serializers.IntegerField(required=False)


class WorkItemSerializer(serializers.ModelSerializer[WorkItem]):
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


class ComparedLabelSerializer(serializers.ModelSerializer[Label]):
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


class PersonSerializer(Fields):
    """The name of the member who is to do it."""

    person = LineField(max_length=150)


class PersonAndCount(PersonSerializer):
    """The member who is to do the most urgent free items, and how many of them."""

    count = serializers.IntegerField(min_value=1, max_value=MOST_ASSIGNED)


class GivenSerializer(serializers.Serializer[Any]):
    """How many more items the person has now."""

    given = serializers.IntegerField()


def person_called(world: World, name: str) -> User:
    """Return the member whom admins may give an item. Raises Refusal where there is none."""
    members: Any = row_field(AssignForm(world), "person").queryset
    person = find_account(name)
    if person is None or not members.filter(pk=person.pk).exists():
        said = "Choose a person of this world."
        raise Refusal(said, "no_such_member", problems=[{"field": "person", "message": said}])
    return person


class WorkItemViewSet(RowsViewSet):
    """The items of the work queue, the oldest first. The queue itself knows who may do one."""

    model = WorkItem
    serializer_class = WorkItemSerializer
    filterset_class = WorkItemQuery
    duties = {"create": Duty.REVIEW} | dict.fromkeys(
        ("assign", "withdraw", "assign_many"), Duty.MANAGE
    )
    sorts = {"id": "pk", "created": "created_at", "priority": "priority"}
    unrecorded = ("next",)

    def get_serializer_class(self) -> type[WorkItemSerializer]:
        return ComparedWorkItemSerializer if self.action == "retrieve" else WorkItemSerializer

    def rows(self) -> WorkItemQuerySet:
        return self.world.work_items.present().select_related("utterance").prefetch_related(PARTS)

    @extend_schema(request=WhatToAsk, responses={201: WorkItemSerializer})
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Asks for a look at a row."""
        sent = self.read(WhatToAsk)
        subject = get_object_or_404(ASKABLE[sent["kind"]](self.world), pk=sent["id"])
        if not ask_about(self.world, subject, sent["reason"], request.user):
            said = "Somebody is asked about this already."
            raise Refusal(said, "asked_already", HTTPStatus.CONFLICT)
        rows = self.rows().filter(**{sent["kind"]: subject, "kind": WorkKind.REQUESTED})
        return self.show(rows.order_by("-pk")[0], HTTPStatus.CREATED)

    def held(self) -> Assignment:
        """Return the caller's assignment of the item. Raises Http404, or Refusal where they have none."""
        assignments = Assignment.objects.held().filter(person=self.request.user)
        item = self.world.work_items.present().filter(pk=self.kwargs["pk"])
        found = assignments.filter(item__in=item).select_related("item__utterance").first()
        if found is None:
            get_object_or_404(item)
            said = "This is not yours now. POST to next/ to get an item."
            raise Refusal(said, "not_yours_now", HTTPStatus.CONFLICT)
        return found

    def shown(self) -> Response:
        """Answer with the item as it is now, without an ETag: other people change it as well."""
        return Response(self.get_serializer(self.rows().get(pk=self.kwargs["pk"])).data)

    @extend_schema(
        operation_id="work_item_next",
        request=None,
        responses={
            200: WorkItemSerializer,
            204: OpenApiResponse(description="There is nothing that the caller can do now."),
        },
    )
    @action(detail=False, methods=["post"])
    def next(self, request: ApiRequest, **kwargs: object) -> Response:
        """Gives the caller the item they hold, or the most urgent one that is free."""
        given = next_item(request.user, self.world)
        if given is None:
            return Response(status=HTTPStatus.NO_CONTENT)
        prefetch_related_objects([given.item], PARTS)
        return Response(WorkItemSerializer(given.item).data)

    @extend_schema(
        operation_id="work_item_finish",
        request=AnswerSerializer,
        responses={
            200: WorkItemSerializer,
        },
    )
    @action(detail=True, methods=["post"])
    def finish(self, request: ApiRequest, **kwargs: object) -> Response:
        """Ends the caller's part of an item, with a label where it is about an utterance."""
        assignment, sent = self.held(), self.read(AnswerSerializer)
        item = assignment.item
        try:
            if end_item(assignment, sent.get("verdict", ""), sent["form"], sent["reason"]):
                return self.shown()
            if item.utterance is None:
                finish(assignment)
                return self.shown()
            verdict, version = sent.pop("verdict", Verdict.FORM), sent.pop("version", None)
            if version is None and not item.is_for_two and verdict != Verdict.SKIP:
                raise PreconditionRequired(
                    "Send the version of the utterance as you read it, so that nobody's answer is "
                    "overwritten unseen."
                )
            by = request.user
            answer(
                item.utterance, verdict, by=by, version=version or 0, assignment=assignment, **sent
            )
        except LanguageError as error:
            raise refusal_of_text(error, "form") from error
        return self.shown()

    @extend_schema(
        operation_id="work_item_give_back", request=None, responses={200: WorkItemSerializer}
    )
    @action(detail=True, methods=["post"], url_path="give-back")
    def give_back(self, request: ApiRequest, **kwargs: object) -> Response:
        """Returns an item that the caller holds, for others."""
        give_back(self.held())
        return self.shown()

    @extend_schema(operation_id="work_item_skip", request=None, responses={200: WorkItemSerializer})
    @action(detail=True, methods=["post"])
    def skip(self, request: ApiRequest, **kwargs: object) -> Response:
        """Returns an item that the caller holds; they do not get it again."""
        skip(self.held())
        return self.shown()

    @extend_schema(operation_id="work_item_take", request=None, responses={200: WorkItemSerializer})
    @action(detail=True, methods=["post"])
    def take(self, request: ApiRequest, **kwargs: object) -> Response:
        """Gives the caller this very item."""
        take(request.user, self.get_object())
        return self.shown()

    @extend_schema(
        operation_id="work_item_assign",
        request=PersonSerializer,
        responses={200: WorkItemSerializer},
    )
    @action(detail=True, methods=["post"])
    def assign(self, request: ApiRequest, **kwargs: object) -> Response:
        """Gives an item to a member, without end."""
        item = self.get_object()
        person = person_called(self.world, self.read(PersonSerializer)["person"])
        assign(item, person, by=request.user)
        return self.shown()

    @extend_schema(
        operation_id="work_item_withdraw", request=None, responses={200: WorkItemSerializer}
    )
    @action(detail=True, methods=["post"])
    def withdraw(self, request: ApiRequest, **kwargs: object) -> Response:
        """Takes an item from whoever has it, for others."""
        for assignment in self.get_object().assignments.held():
            withdraw(assignment)
        return self.shown()

    @extend_schema(
        operation_id="work_items_assign", request=PersonAndCount, responses={200: GivenSerializer}
    )
    @action(
        detail=False,
        methods=["post"],
        url_path="assign",
        url_name="assign-many",
        filterset_class=WorkItemFilters,
        pagination_class=None,
    )
    @once
    def assign_many(self, request: ApiRequest, **kwargs: object) -> Response:
        """Gives a member the most urgent free items among those that the filters of the page choose."""
        sent = self.read(PersonAndCount)
        person = person_called(self.world, sent["person"])
        rows: Any = self.filter_queryset(self.get_queryset())
        return Response({"given": assign_first(rows, person, sent["count"], request.user)})
