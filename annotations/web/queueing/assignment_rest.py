"""Who does an item of the work queue: what people take themselves, what an admin gives them, and shares."""

from __future__ import annotations

from typing import Any, ClassVar

from django.db import transaction
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.filters import BaseFilterBackend
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.models import Duty, Scope, User, WorkItem, WorkKind, WorkShare, World
from annotations.queueing.enqueuing import DOUBLE_KINDS, set_share, shares_of
from annotations.queueing.giving import NotForThem, assign, assign_first, take, withdraw
from annotations.web.queueing.queueing_filters import WorkItemFilters
from annotations.web.queueing.work_item_forms import MOST_ASSIGNED, AssignForm
from annotations.web.queueing.work_item_rest import WorkItemNoun, WorkItemSerializer, WorkItemVerb
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.matching import etag_of, require_match
from annotations.web.rest.problem_details import Conflict, Refused
from annotations.web.rest.routes import WorldRoute


class PersonSerializer(Fields):
    """The name of the member who is to do it."""

    person = LineField(max_length=150)


class PersonAndCount(PersonSerializer):
    """The member who is to do the most urgent free items, and how many of them."""

    count = serializers.IntegerField(min_value=1, max_value=MOST_ASSIGNED)


class GivenSerializer(serializers.Serializer):
    """How many items the person has beside those that they had."""

    given = serializers.IntegerField()


def person_called(world: World, name: str) -> User:
    """Return the member whom admins may give an item. Raises Refused."""
    members = AssignForm(world).fields["person"].queryset
    person: User | None = members.filter(username=name).first()
    if person is None:
        said = "Choose a person of this world."
        raise Refused(said, [{"field": "person", "message": said}])
    return person


class GivingVerb(WorkItemVerb):
    filter_backends: ClassVar[list[type[BaseFilterBackend]]] = []

    def item(self) -> WorkItem:
        row: WorkItem = self.get_object()
        return row


class TakeWorkItem(GivingVerb):
    """Gives the caller this very item."""

    @extend_schema(operation_id="work_item_take", request=None, responses={200: WorkItemSerializer})
    def post(self, request: Request, world: str, pk: int) -> Response:
        try:
            take(request.user, self.item())
        except NotForThem as error:
            raise Conflict(str(error)) from error
        return self.shown(pk)


class AssignWorkItem(GivingVerb):
    """Gives an item to a member, without end."""

    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.MANAGE}

    @extend_schema(
        operation_id="work_item_assign",
        request=PersonSerializer,
        responses={200: WorkItemSerializer},
    )
    def post(self, request: Request, world: str, pk: int) -> Response:
        item = self.item()
        person = person_called(self.world, self.read(PersonSerializer)["person"])
        try:
            assign(item, person, by=request.user)
        except NotForThem as error:
            raise Conflict(str(error)) from error
        return self.shown(pk)


class WithdrawWorkItem(GivingVerb):
    """Takes an item from whoever has it, for others."""

    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.MANAGE}

    @extend_schema(
        operation_id="work_item_withdraw", request=None, responses={200: WorkItemSerializer}
    )
    def post(self, request: Request, world: str, pk: int) -> Response:
        for part in self.item().assignments.held():
            withdraw(part)
        return self.shown(pk)


class AssignWorkItems(WorkItemNoun, WorldRoute):
    """Gives a member the most urgent free items among those that the filters of the page choose."""

    http_method_names = ["post", "options"]
    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.MANAGE}
    filterset_class = WorkItemFilters
    pagination_class = None

    @extend_schema(
        operation_id="work_items_assign", request=PersonAndCount, responses={200: GivenSerializer}
    )
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        sent = self.read(PersonAndCount)
        person = person_called(self.world, sent["person"])
        rows = self.filter_queryset(self.get_queryset())
        return Response({"given": assign_first(rows, person, sent["count"], request.user)})


class SharesSerializer(serializers.Serializer):
    """The share of items of each kind that two people do independently of each other, in percent."""

    def get_fields(self) -> dict[str, Any]:
        shares = {
            str(kind): serializers.IntegerField(min_value=0, max_value=100) for kind in DOUBLE_KINDS
        }
        return {**super().get_fields(), **shares}


class SharesChange(SharesSerializer, Fields):
    """Shares that are to be others. Items that nobody has taken yet follow them."""


class QueueSettings(WorldRoute):
    """Shows and changes how many items of each kind two people do."""

    model = WorkShare
    serializer_class = SharesSerializer
    filter_backends: ClassVar[list[type[BaseFilterBackend]]] = []
    pagination_class = None
    duties: ClassVar[dict[str, Duty]] = {"GET": Duty.MANAGE, "PATCH": Duty.MANAGE}
    scopes: ClassVar[dict[str, Scope]] = {"GET": Scope.READ}
    conditional = ("PATCH",)

    @extend_schema(operation_id="queue_settings", responses={200: SharesSerializer})
    def get(self, request: Request, **kwargs: object) -> Response:
        shown = shares_of(self.world)
        return Response(shown, headers={"ETag": etag_of(None, shown)})

    @extend_schema(
        operation_id="set_queue_settings", request=SharesChange, responses={200: SharesSerializer}
    )
    def patch(self, request: Request, **kwargs: object) -> Response:
        sent = self.read(SharesChange, partial=True)
        with transaction.atomic():
            self.hold_world()
            shown = shares_of(self.world)
            require_match(request, shown, shown)
            for kind, percent in sent.items():
                set_share(self.world, WorkKind(kind), percent)
        return self.get(request)
