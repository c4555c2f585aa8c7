"""The productions of the command grammar, and its task categories."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from django.db.models import QuerySet
from rest_framework import serializers

from annotations.language.texts import MAX_NONTERMINAL, MAX_PATTERN, Problem
from annotations.models import Production, TaskCategory
from annotations.web.description.description_filters import ProductionFilters
from annotations.web.description.production_forms import (
    ProductionForm,
    initial_values,
    unsaved_production,
)
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.routes import EditableViewSet, Noun, RowsRoute


class ProductionSerializer(serializers.ModelSerializer[Production]):
    """A line of the grammar: what a nonterminal may become. The nonterminal changes by renaming."""

    class Meta:
        model = Production
        fields = [
            *("id", "nonterminal", "expansion", "source", "line", "task_category"),
            *("position", "version"),
        ]


class ProductionChange(Fields):
    expansion = serializers.CharField(max_length=MAX_PATTERN)


class NewProduction(ProductionChange):
    """``source`` is the file of the grammar that the line is added to."""

    nonterminal = LineField(max_length=MAX_NONTERMINAL)
    source = LineField(max_length=200)  # type: ignore[assignment]  # the name of the column


class ProductionNoun(Noun):
    model = Production
    serializer_class = ProductionSerializer
    new_serializer = NewProduction
    change_serializer = ProductionChange

    def rows(self) -> QuerySet[Production]:
        return Production.objects.filter(grammar__world=self.world)

    def form_of(self, row: Production | None, sent: Mapping[str, Any]) -> ProductionForm:
        stored = initial_values(row) if row else {}
        return ProductionForm(self.world, row, {**stored, **sent}, initial=stored)

    def unsaved(self, form: ProductionForm) -> Production:
        return unsaved_production(self.world, form)

    def values_of(self, form: ProductionForm, row: Production) -> Mapping[str, Any]:
        return {"expansion": form.cleaned_data["expansion"]}

    def problems_of(self, form: ProductionForm) -> Iterable[Problem]:
        return form.remarks


class ProductionViewSet(ProductionNoun, EditableViewSet):
    """The lines of the grammar."""

    filterset_class = ProductionFilters
    sorts = {"position": "position", "nonterminal": "nonterminal", "id": "pk"}


class TaskCategorySerializer(serializers.ModelSerializer[TaskCategory]):
    """A class of commands, with the files that it is generated from, in order."""

    rule_sources = serializers.ListField(child=serializers.CharField())
    template_sources = serializers.ListField(child=serializers.CharField())

    class Meta:
        model = TaskCategory
        fields = [
            *("id", "name", "position", "rule_sources", "template_sources"),
            *("commands_in_grammar", "commands_with_form"),
        ]


class TaskCategories(RowsRoute):
    """Lists the task categories of the grammar."""

    model = TaskCategory
    serializer_class = TaskCategorySerializer
    sorts = {"position": "position", "name": "name"}

    def rows(self) -> QuerySet[TaskCategory]:
        return TaskCategory.objects.filter(grammar__world=self.world)
