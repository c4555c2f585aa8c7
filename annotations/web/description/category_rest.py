"""The task categories of the grammar."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.editing.task_categories import order_categories
from annotations.models import Duty, TaskCategory
from annotations.web.description.category_forms import TaskCategoryForm
from annotations.web.editing.noun_rest import NounViewSet
from annotations.web.rest.fields import Fields
from annotations.web.rest.form_fields import FormFields
from annotations.web.rest.permissions import ApiRequest


class TaskCategorySerializer(serializers.ModelSerializer[TaskCategory]):
    """A class of commands, with the files that it is generated from, in order; its own are the last."""

    rule_sources = serializers.ListField(child=serializers.CharField())
    template_sources = serializers.ListField(child=serializers.CharField())

    class Meta:
        model = TaskCategory
        fields = [
            *("id", "name", "position", "rule_sources", "template_sources"),
            *("commands_in_grammar", "commands_with_form", "version"),
        ]


class TaskCategoryChange(FormFields):
    """Without ``rule_sources`` and ``template_sources`` a new one has sets of its own, named after it."""

    rule_sources = serializers.ListField(child=serializers.CharField(), required=False)
    template_sources = serializers.ListField(child=serializers.CharField(), required=False)

    class Meta:
        form = TaskCategoryForm
        fields: list[str] = []


class NewTaskCategory(TaskCategoryChange):
    class Meta(TaskCategoryChange.Meta):
        fields = [*TaskCategoryForm.fixed]


class OrderOfCategories(Fields):
    """The keys of all task categories in their new order."""

    order = serializers.ListField(child=serializers.IntegerField(), max_length=1_000)


class TaskCategoryViewSet(NounViewSet):
    """The task categories of the grammar. One that alone uses productions or templates stays."""

    noun_form = TaskCategoryForm
    serializer_class = TaskCategorySerializer
    new_serializer = NewTaskCategory
    change_serializer = TaskCategoryChange
    sorts = {"position": "position", "name": "name", "id": "pk"}
    duties = {**NounViewSet.duties, "order": Duty.ANNOTATE}

    def _written(self, row: Any, remarks: Any, status: int = HTTPStatus.OK) -> Response:
        row.refresh_from_db(fields=["commands_in_grammar", "commands_with_form"])  # counted anew
        return super()._written(row, remarks, status)

    @extend_schema(request=OrderOfCategories, responses={200: TaskCategorySerializer(many=True)})
    @action(detail=False, methods=["post"])
    def order(self, request: ApiRequest, **kwargs: Any) -> Response:
        """Orders them; a command that two of them make belongs to the first."""
        order_categories(self.world, self.read(OrderOfCategories)["order"], request.user)
        return Response(self.get_serializer(self.rows(), many=True).data)
