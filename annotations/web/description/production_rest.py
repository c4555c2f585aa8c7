"""The productions of the command grammar, and its task categories."""

from __future__ import annotations

from django.db.models import QuerySet
from rest_framework import serializers

from annotations.models import Production, TaskCategory
from annotations.web.description.description_filters import ProductionFilters
from annotations.web.description.production_forms import ProductionForm
from annotations.web.editing.noun_rest import NounViewSet
from annotations.web.rest.fields import LineField
from annotations.web.rest.form_fields import FormFields
from annotations.web.rest.routes import RowsRoute


class ProductionSerializer(serializers.ModelSerializer[Production]):
    """A line of the grammar: what a nonterminal may become. The nonterminal changes by renaming."""

    class Meta:
        model = Production
        fields = [
            *("id", "nonterminal", "expansion", "source", "line", "task_category"),
            *("position", "version"),
        ]


class ProductionChange(FormFields):
    class Meta:
        form = ProductionForm
        fields = [*ProductionForm.edited]


class NewProduction(ProductionChange):
    """``source`` is the file of the grammar that the line is added to."""

    source = LineField(max_length=200)  # type: ignore[assignment]  # the name of the column

    class Meta(ProductionChange.Meta):
        fields = ["nonterminal", "expansion"]


class ProductionViewSet(NounViewSet):
    """The lines of the grammar."""

    noun_form = ProductionForm
    serializer_class = ProductionSerializer
    new_serializer = NewProduction
    change_serializer = ProductionChange
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
