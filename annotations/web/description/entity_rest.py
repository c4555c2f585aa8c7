"""The entities of the ontology."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from django.db.models import QuerySet
from rest_framework import serializers

from annotations.language.forms import MAX_TOKEN
from annotations.language.texts import MAX_ENTITY, Problem, Refusal
from annotations.models import Entity
from annotations.web.description.description_filters import EntityFilters
from annotations.web.description.entity_forms import EntityForm, initial_values, ontology_in
from annotations.web.rest.fields import AttributesField, Fields, LineField
from annotations.web.rest.routes import EditableViewSet


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


class EntityViewSet(EditableViewSet):
    """The entities of the ontology."""

    model = Entity
    serializer_class = EntitySerializer
    new_serializer = NewEntity
    change_serializer = EntityChange
    filterset_class = EntityFilters
    sorts = {"position": "position", "text": "text", "class": "entity_class", "id": "pk"}

    def rows(self) -> QuerySet[Entity]:
        return Entity.objects.filter(ontology__world=self.world)

    def form_of(self, row: Entity | None, sent: Mapping[str, Any]) -> EntityForm:
        given = dict(sent)
        if "aliases" in sent:
            given["aliases"] = "\n".join(sent["aliases"])
        if "attributes" in sent:
            lines = (f"{name}: {text}" for name, text in sent["attributes"].items())
            given["attributes"] = "\n".join(lines)
        stored = initial_values(row) if row else {}
        return EntityForm(self.world, row, {**stored, **given}, initial=stored)

    def valid_form(self, row: Entity | None, sent: Mapping[str, Any]) -> EntityForm:
        form: EntityForm = super().valid_form(row, sent)
        if row is None and form.additions.duplicates:
            said = "This entity is there already."
            problem = {"field": "text", "message": said}
            raise Refusal(said, "is_there_already", problems=[problem])
        return form

    def unsaved(self, form: EntityForm) -> Entity:
        return Entity(ontology=ontology_in(self.world), **form.values)

    def values_of(self, form: EntityForm, row: Entity) -> Mapping[str, Any]:
        return form.values

    def problems_of(self, form: EntityForm) -> Iterable[Problem]:
        return form.additions.problems
