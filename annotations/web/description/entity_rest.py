"""The entities of the ontology."""

from __future__ import annotations

from typing import Any

from rest_framework import serializers

from annotations.language.forms import MAX_TOKEN
from annotations.language.texts import MAX_ENTITY
from annotations.models import Entity
from annotations.web.description.description_filters import EntityFilters
from annotations.web.description.entity_forms import EntityForm
from annotations.web.editing.noun_rest import NounViewSet
from annotations.web.rest.fields import AttributesField, Fields, LineField


class EntitySerializer(serializers.ModelSerializer[Entity]):
    """A thing, place, person or phrase that commands name. ``text`` changes by renaming."""

    attributes = serializers.DictField(child=serializers.CharField(allow_blank=True))
    aliases = serializers.ListField(child=serializers.CharField())

    class Meta:
        model = Entity
        fields = [
            *("id", "entity_class", "text", "aliases", "attributes"),
            *("source", "line", "position", "version"),
        ]


class EntityChange(Fields):
    entity_class = LineField(max_length=MAX_TOKEN, help_text="The token of a class of the world.")
    aliases = serializers.ListField(child=LineField(max_length=MAX_ENTITY), max_length=200)
    attributes = AttributesField()


class NewEntity(EntityChange):
    text = LineField(max_length=MAX_ENTITY)

    def get_fields(self) -> dict[str, Any]:
        fields = super().get_fields()
        for name in ("aliases", "attributes"):
            fields[name].required = False
        return fields


class EntityViewSet(NounViewSet):
    """The entities of the ontology."""

    noun_form = EntityForm
    serializer_class = EntitySerializer
    new_serializer = NewEntity
    change_serializer = EntityChange
    filterset_class = EntityFilters
    sorts = {"position": "position", "text": "text", "class": "entity_class", "id": "pk"}
