"""The classes of the entities."""

from __future__ import annotations

from rest_framework import serializers

from annotations.models import EntityClass
from annotations.web.description.class_forms import EntityClassForm
from annotations.web.editing.noun_rest import NounViewSet
from annotations.web.rest.form_fields import FormFields


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
    """The classes of the entities. Those that every world has stay, and those that something uses."""

    noun_form = EntityClassForm
    serializer_class = EntityClassSerializer
    new_serializer = NewEntityClass
    change_serializer = EntityClassChange
    sorts = {"position": "position", "token": "token", "id": "pk"}
