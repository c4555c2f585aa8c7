"""The worlds that the caller sees."""

from __future__ import annotations

from django.db.models import QuerySet
from rest_framework import serializers
from rest_framework.generics import GenericAPIView
from rest_framework.mixins import ListModelMixin
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.api.paging import Keyset
from annotations.api.permissions import HasScope
from annotations.api.routes import RowRoute
from annotations.models import World


class WorldSerializer(serializers.ModelSerializer):
    """A world, and what the caller may do in it."""

    duties = serializers.SerializerMethodField()
    commands_are_stale = serializers.BooleanField()

    class Meta:
        model = World
        fields = ["name", "description", "created_at", "commands_are_stale", "duties"]

    def get_duties(self, world: World) -> list[str]:
        by_world = self.context["duties"]
        return sorted(by_world.get(world.pk, ()))


class WorldNoun:
    model = World
    serializer_class = WorldSerializer

    def get_serializer_context(self) -> dict[str, object]:
        context = super().get_serializer_context()
        if getattr(self, "swagger_fake_view", False):
            return context
        duties = World.objects.visible_to(self.request.user).duties_by_world(self.request.user)
        return {**context, "duties": duties}


class Worlds(WorldNoun, ListModelMixin, GenericAPIView):
    """Lists the worlds that the caller is a member of."""

    permission_classes = [HasScope]
    pagination_class = Keyset
    filter_backends = []
    sorts = {"name": "name"}

    def get_queryset(self) -> QuerySet[World]:
        return World.objects.visible_to(self.request.user)

    def get(self, request: Request) -> Response:
        return self.list(request)


class OneWorld(WorldNoun, RowRoute):
    """Shows a world."""

    def get_object(self) -> World:
        return self.world
