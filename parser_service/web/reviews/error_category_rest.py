"""The error categories of a world."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.db.models import QuerySet
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.models import Duty
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import RowsViewSet
from parser_service.models import ErrorCategory
from parser_service.reviews.world_categories import (
    add_category,
    change_category,
    delete_category,
    ensure_categories,
    move_category,
)
from parser_service.web.reviews.error_category_forms import CategoryForm, DeletionForm

LARGEST_KEY = 2**63 - 1
MOVE_TO = OpenApiParameter(
    "move_to", OpenApiTypes.INT, description="The category that gets its reviews."
)


class ErrorCategorySerializer(serializers.ModelSerializer[ErrorCategory]):
    """A kind of error. Errors in ``slice`` are proposed for it."""

    slice = serializers.IntegerField(source="slice_id", allow_null=True)

    class Meta:
        model = ErrorCategory
        fields = ["id", "code", "name", "description", "slice", "position"]


class CategoryChange(Fields):
    name = LineField(max_length=60)
    description = LineField(max_length=300, allow_blank=True, required=False)
    slice = serializers.IntegerField(
        min_value=1, max_value=LARGEST_KEY, allow_null=True, required=False
    )


class CategoryStep(Fields):
    """One place up (-1) or down (1); the key on the review page follows."""

    step = serializers.ChoiceField(choices=[-1, 1])


class ErrorCategoryViewSet(RowsViewSet):
    """The error categories of a world."""

    model = ErrorCategory
    serializer_class = ErrorCategorySerializer
    duties = dict.fromkeys(("create", "partial_update", "destroy", "move"), Duty.MANAGE)
    conditional = ("partial_update", "destroy")
    sorts = {"position": "position", "name": "name", "id": "pk"}

    def rows(self) -> QuerySet[ErrorCategory]:
        ensure_categories(self.world)
        return self.world.error_categories.select_related("world")

    def valid(self, sent: dict[str, Any], row: ErrorCategory | None = None) -> dict[str, Any]:
        """Return what the form of the page makes of ``sent``, beside what ``row`` has. Raises Refusal."""
        stored = ErrorCategorySerializer(row).data if row else {}
        form = CategoryForm(self.world, {**stored, **sent}, instance=row)
        if not form.is_valid():
            raise refusal_of_form(form)
        return dict(form.cleaned_data)

    @extend_schema(request=CategoryChange, responses={201: ErrorCategorySerializer})
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Adds an error category behind the others."""
        ensure_categories(self.world)
        values = self.valid(self.read(CategoryChange))
        added = add_category(self.world, values["name"], values["description"], values["slice"])
        return self.show(added, HTTPStatus.CREATED)

    def hold(self) -> None:
        """Hold all categories: they have one order and different names."""
        self.hold_world()

    @extend_schema(request=CategoryChange, responses={200: ErrorCategorySerializer})
    def partial_update(self, request: ApiRequest, **kwargs: object) -> Response:
        """Changes an error category."""
        with self.matching() as row:
            values = self.valid(self.read(CategoryChange, partial=True), self.get_object())
            change_category(row, values["name"], values["description"], values["slice"])
        return self.show(row)

    @extend_schema(parameters=[MOVE_TO])
    def destroy(self, request: ApiRequest, **kwargs: object) -> Response:
        """Deletes an error category; another one may get its reviews."""
        with self.matching() as row:
            form = DeletionForm(row, request.query_params)
            if not form.is_valid():
                raise refusal_of_form(form)
            delete_category(row, form.cleaned_data["move_to"])
        return Response(status=HTTPStatus.NO_CONTENT)

    @extend_schema(request=CategoryStep, responses={200: ErrorCategorySerializer})
    @action(detail=True, methods=["post"])
    def move(self, request: ApiRequest, **kwargs: object) -> Response:
        """Puts an error category one place up or down."""
        move_category(self.get_object(), self.read(CategoryStep)["step"])
        return self.show(self.get_object())
