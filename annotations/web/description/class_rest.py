"""The classes of the entities."""

from __future__ import annotations

from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.editing.household_classes import add_household
from annotations.models import Duty, EntityClass
from annotations.web.description.class_forms import EntityClassForm
from annotations.web.editing.noun_rest import NounViewSet
from annotations.web.rest.form_fields import FormFields
from annotations.web.rest.permissions import ApiRequest


class EntityClassSerializer(serializers.ModelSerializer[EntityClass]):
    """A class of entities. ``token`` is the word of its wildcard and its class token, and does not change.

    ``said`` is the noun for one that a form leaves open, ``hue`` the angle of its colour. The members of a
    class that ``is_closed`` are all listed, and are descriptions or sentences.
    """

    class Meta:
        model = EntityClass
        fields = [
            *("id", "token", "singular", "plural", "said", "hue"),
            *("is_closed", "position", "version"),
        ]


class EntityClassChange(FormFields):
    class Meta:
        form = EntityClassForm
        fields = [*EntityClassForm.edited]


class NewEntityClass(EntityClassChange):
    class Meta(EntityClassChange.Meta):
        fields = [*EntityClassForm.fixed, *EntityClassForm.edited]


class EntityClassViewSet(NounViewSet):
    """The classes of the entities. Those that something uses stay."""

    noun_form = EntityClassForm
    serializer_class = EntityClassSerializer
    new_serializer = NewEntityClass
    change_serializer = EntityClassChange
    sorts = {"position": "position", "token": "token", "id": "pk"}
    duties = {**NounViewSet.duties, "household": Duty.ANNOTATE}

    @extend_schema(request=None, responses={200: EntityClassSerializer(many=True)})
    @action(detail=False, methods=["post"])
    def household(self, request: ApiRequest, **kwargs: Any) -> Response:
        """Adds those of a household, which GPSRCmdGen has, where they are missing."""
        add_household(self.world, request.user)
        return Response(self.get_serializer(self.rows(), many=True).data)
