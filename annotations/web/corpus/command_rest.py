"""What templates make: commands and their logical forms. They change with the templates alone."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.generation.complexity import kept_complexity
from annotations.models import Command, LogicalForm
from annotations.web.corpus.corpus_filters import CommandFilters, LogicalFormFilters
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import Figures, RowsViewSet


class CommandSerializer(serializers.ModelSerializer[Command]):
    """A generated command with its form; ``template`` makes it."""

    logical_form = serializers.CharField(source="logical_form.text")
    logical_form_id = serializers.IntegerField()
    template = serializers.IntegerField(source="template_id", allow_null=True)

    class Meta:
        model = Command
        fields = [
            *("id", "anonymized_text", "logical_form", "logical_form_id", "template"),
            *("task_category", "is_in_grammar", "length", "position"),
        ]


class CommandViewSet(RowsViewSet):
    """The commands that the templates make."""

    model = Command
    serializer_class = CommandSerializer
    filterset_class = CommandFilters
    sorts = {"position": "position", "text": "anonymized_text", "length": "length", "id": "pk"}

    def rows(self) -> QuerySet[Command]:
        return self.world.commands.select_related("logical_form")


class LogicalFormSerializer(serializers.ModelSerializer[LogicalForm]):
    """One meaning, in canonical corpus notation; ``length`` counts tokens."""

    class Meta:
        model = LogicalForm
        fields = ["id", "text", "head_predicate", "depth", "length", "task_category"]


class LogicalFormViewSet(RowsViewSet):
    """The logical forms of the commands."""

    model = LogicalForm
    serializer_class = LogicalFormSerializer
    filterset_class = LogicalFormFilters
    sorts = {"id": "pk", "text": "text", "length": "length", "depth": "depth"}

    def rows(self) -> QuerySet[LogicalForm]:
        return self.world.logical_forms.all()


class ComplexitySerializer(serializers.Serializer[Any]):
    """A column of the table of complexity; ``task_category`` is empty for all together. Lengths in tokens."""

    task_category = serializers.CharField(allow_blank=True)
    templates = serializers.IntegerField()
    commands = serializers.IntegerField()
    forms = serializers.IntegerField()
    mean_command_length = serializers.FloatField(allow_null=True)
    mean_form_length = serializers.FloatField(allow_null=True)
    commands_per_form = serializers.FloatField(allow_null=True)


class ComplexityTable(serializers.Serializer[Any]):
    results = ComplexitySerializer(many=True)


class ComplexityOfWorld(Figures):
    """Shows how long and how varied the commands of each task category are."""

    model = Command

    @extend_schema(operation_id="complexity", responses={200: ComplexityTable})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        return Response(ComplexityTable({"results": kept_complexity(self.world)}).data)
