"""The worlds that the caller sees: made, described and deleted as on the pages."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.exceptions import PermissionDenied
from rest_framework.response import Response

from annotations.exchange.shipped_worlds import SHIPPED_WORLDS
from annotations.exchange.world_deletion import request_deletion, start_deletion
from annotations.models import Duty, Job, World
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest, ChangedBySiteAdmins, ForSiteAdmins
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import ManyRows, RowRoute, Tagged
from annotations.web.rest.samples import SampleNoteSerializer
from annotations.web.worlds.job_rest import JobSerializer, accepted
from annotations.web.worlds.world_forms import NewWorldForm, WorldForm


class WorldSerializer(serializers.ModelSerializer[World]):
    """A world, and what the caller may do in it."""

    duties = serializers.SerializerMethodField()
    commands_are_stale = serializers.BooleanField()
    sample = serializers.SerializerMethodField()

    class Meta:
        model = World
        fields = ["name", "description", "created_at", "commands_are_stale", "sample", "duties"]

    @extend_schema_field(SampleNoteSerializer(allow_null=True))
    def get_sample(self, world: World) -> Any:
        return world.sample or None

    def get_duties(self, world: World) -> list[str]:
        by_world = self.context["duties"]
        return sorted(by_world.get(world.pk, ()))


class WorldChange(Fields):
    """The name of a world is in all addresses below it: after a change they begin with the new one."""

    name = serializers.CharField(max_length=60)
    description = serializers.CharField(max_length=10_000, allow_blank=True)


class NewWorld(Fields):
    """A world, empty or with what a shipped one holds (``starts_with``)."""

    name = serializers.CharField(max_length=60)
    description = serializers.CharField(max_length=10_000, allow_blank=True, default="")
    starts_with = serializers.ChoiceField(
        choices=list(SHIPPED_WORLDS), allow_blank=True, default=""
    )


class WorldShowing(Tagged):
    """What the routes of worlds have in common: a world is shown with what the caller may do in it."""

    model = World
    serializer_class = WorldSerializer

    def get_serializer_context(self) -> dict[str, object]:
        context = dict(super().get_serializer_context())
        if getattr(self, "swagger_fake_view", False):
            return context
        duties = World.objects.visible_to(self.request.user).duties_by_world(self.request.user)
        return {**context, "duties": duties}


class Worlds(WorldShowing, ManyRows):
    """Lists the worlds that the caller is a member of; administrators of the site make another one."""

    permission_classes = [ChangedBySiteAdmins]
    filter_backends = []
    sorts = {"name": "name"}

    duties = {"POST": Duty.MANAGE}

    def rows(self) -> QuerySet[World]:
        return World.objects.visible_to(self.request.user)

    @extend_schema(request=NewWorld, responses={201: WorldSerializer, 202: JobSerializer})
    @once
    def post(self, request: ApiRequest) -> Response:
        """Make a world; where it starts with a shipped one, the answer is the job that loads it (202)."""
        form = NewWorldForm(self.read(NewWorld))
        created = form.create(request.user) if form.is_valid() else None
        if created is None:
            raise refusal_of_form(form)
        if (job := form.load(created, request.user)) is not None:
            return accepted(request, job)
        response = self.show(created, HTTPStatus.CREATED)
        response["Location"] = request.build_absolute_uri(f"{request.path}{created.name}/")
        return response


class OneWorld(WorldShowing, RowRoute):
    """Shows a world; its admins rename and describe it, administrators of the site delete it."""

    duties = {"PATCH": Duty.MANAGE, "DELETE": Duty.MANAGE}
    conditional = ("PATCH", "DELETE")

    def get_object(self) -> World:
        return self.world

    @extend_schema(request=WorldChange, responses={200: WorldSerializer})
    def patch(self, request: ApiRequest, **kwargs: object) -> Response:
        with self.matching() as row:
            sent = self.read(WorldChange, partial=True)
            form = WorldForm(
                {"name": row.name, "description": row.description, **sent}, instance=row
            )
            if not (form.is_valid() and form.change()):
                raise refusal_of_form(form)
        return self.show(row)

    @extend_schema(request=None, responses={202: JobSerializer, 204: None})
    def delete(self, request: ApiRequest, **kwargs: object) -> Response:
        """Delete the world with all that is in it: at once where it is small, otherwise by a job."""
        if not request.user.is_superuser:
            raise PermissionDenied(ForSiteAdmins.message)
        with self.matching() as row:
            request_deletion(row)  # whoever was as quick finds no world
        started = start_deletion(row, request.user)
        if isinstance(started, Job):
            return accepted(request, started)
        return Response(status=HTTPStatus.NO_CONTENT)

    def hold(self) -> None:
        self.hold_world()
