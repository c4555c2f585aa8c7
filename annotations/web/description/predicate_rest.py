"""The predicates of the logical forms."""

from __future__ import annotations

from collections.abc import Mapping
from http import HTTPStatus
from typing import Any

from django.db.models import QuerySet
from rest_framework import serializers

from annotations.language.texts import MAX_GLOSS, MAX_PREDICATE, Refusal
from annotations.models import Predicate
from annotations.models.description import predicate_kind_choices
from annotations.web.description.description_filters import PredicateFilters
from annotations.web.description.predicate_forms import PredicateForm, initial_values
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.routes import EditableViewSet, Noun


class PredicateSerializer(serializers.ModelSerializer[Predicate]):
    """A predicate. ``signatures`` lists the kinds of its arguments, once for each way to use it."""

    signatures = serializers.ListField(child=serializers.ListField(child=serializers.CharField()))

    class Meta:
        model = Predicate
        fields = ["id", "name", "kind", "signatures", "gloss", "is_edited", "version"]


class PredicateChange(Fields):
    """``signatures`` may mark arguments at the end that may be missing: ``["object", "room?"]``."""

    kind = serializers.ChoiceField(choices=predicate_kind_choices())
    signatures = serializers.ListField(
        child=serializers.ListField(child=LineField(max_length=40), max_length=50), max_length=100
    )
    gloss = LineField(max_length=MAX_GLOSS, allow_blank=True, required=False)


class NewPredicate(PredicateChange):
    name = LineField(max_length=MAX_PREDICATE)


class PredicateNoun(Noun):
    model = Predicate
    serializer_class = PredicateSerializer
    new_serializer = NewPredicate
    change_serializer = PredicateChange

    def rows(self) -> QuerySet[Predicate]:
        return self.world.predicates.all()

    def form_of(self, row: Predicate | None, sent: Mapping[str, Any]) -> PredicateForm:
        given = dict(sent)
        if "signatures" in sent:
            given["signatures"] = "\n".join(f"({', '.join(each)})" for each in sent["signatures"])
        stored = initial_values(row) if row else {}
        return PredicateForm(self.world, row, {**stored, **given}, initial=stored)

    def valid_form(self, row: Predicate | None, sent: Mapping[str, Any]) -> PredicateForm:
        form: PredicateForm = super().valid_form(row, sent)
        if row is None and self.rows().filter(name=form.cleaned_data["name"]).exists():
            said = "There is a predicate of this name already. Change that one."
            problem = {"field": "name", "message": said}
            raise Refusal(said, "is_there_already", HTTPStatus.CONFLICT, [problem])
        return form

    def unsaved(self, form: PredicateForm) -> Predicate:
        return Predicate(world=self.world, name=form.cleaned_data["name"], **form.values)

    def values_of(self, form: PredicateForm, row: Predicate) -> Mapping[str, Any]:
        return form.values


class PredicateViewSet(PredicateNoun, EditableViewSet):
    """The predicates of the logical forms."""

    filterset_class = PredicateFilters
    sorts = {"name": "name", "kind": "kind", "id": "pk"}
