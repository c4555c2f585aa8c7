"""The classes of the entities."""

from __future__ import annotations

from collections.abc import Mapping
from http import HTTPStatus
from typing import Any

from django.db.models import QuerySet
from rest_framework import serializers
from rest_framework.response import Response

from annotations.editing.class_deletion import delete_class
from annotations.language.forms import HUES, MAX_CLASS_WORDS, MAX_TOKEN
from annotations.language.texts import Refusal
from annotations.models import EntityClass
from annotations.web.description.class_forms import EntityClassForm, initial_values
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import EditableViewSet


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


class EntityClassChange(Fields):
    singular = LineField(max_length=MAX_CLASS_WORDS)
    plural = LineField(max_length=MAX_CLASS_WORDS)
    said = LineField(max_length=MAX_CLASS_WORDS)
    hue = serializers.IntegerField(min_value=0, max_value=HUES - 1)
    is_closed = serializers.BooleanField(required=False)


class NewEntityClass(EntityClassChange):
    token = LineField(max_length=MAX_TOKEN)


class EntityClassViewSet(EditableViewSet):
    """The classes of the entities. Those that every world has stay."""

    model = EntityClass
    serializer_class = EntityClassSerializer
    new_serializer = NewEntityClass
    change_serializer = EntityClassChange
    sorts = {"position": "position", "token": "token", "id": "pk"}

    def rows(self) -> QuerySet[EntityClass]:
        return self.world.entity_classes.all()

    def form_of(self, row: EntityClass | None, sent: Mapping[str, Any]) -> EntityClassForm:
        stored = initial_values(row) if row else {}
        return EntityClassForm(self.world, row, {**stored, **sent}, initial=stored)

    def valid_form(self, row: EntityClass | None, sent: Mapping[str, Any]) -> EntityClassForm:
        form: EntityClassForm = super().valid_form(row, sent)
        if row is None and self.rows().filter(token=form.cleaned_data["token"]).exists():
            said = "There is a class of this token already. Change that one."
            problem = {"field": "token", "message": said}
            raise Refusal(said, "is_there_already", HTTPStatus.CONFLICT, [problem])
        return form

    def unsaved(self, form: EntityClassForm) -> EntityClass:
        return EntityClass(world=self.world, token=form.cleaned_data["token"], **form.values)

    def values_of(self, form: EntityClassForm, row: EntityClass) -> Mapping[str, Any]:
        return form.values

    def destroy(self, request: ApiRequest, **kwargs: Any) -> Response:
        """Deletes one that nothing uses; its history can bring it back."""
        row = self.matched()
        delete_class(row, request.user, row.version)
        return Response(status=HTTPStatus.NO_CONTENT)
