"""Saved slices of predictions."""

from __future__ import annotations

from http import HTTPStatus
from typing import ClassVar

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.models import Duty
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.routes import RowRoute, RowsRoute
from parser_service.models import Slice
from parser_service.models.reviews import LONGEST_SLICE_NAME
from parser_service.slices.saving import delete_slice, rename_slice, save_slice

LONGEST_QUERY = 5_000


class SliceSerializer(serializers.ModelSerializer):
    """A saved filter over predictions; ``query`` holds parameters of a list of predictions."""

    created_by = serializers.CharField(source="created_by.username", default=None)

    class Meta:
        model = Slice
        fields = ["id", "name", "query", "created_by", "created_at"]


class SliceName(Fields):
    name = LineField(max_length=LONGEST_SLICE_NAME)


class NewSlice(SliceName):
    query = LineField(max_length=LONGEST_QUERY)


class SliceNoun:
    model = Slice
    serializer_class = SliceSerializer
    duties: ClassVar[dict[str, Duty]] = dict.fromkeys(("POST", "PATCH", "DELETE"), Duty.REVIEW)

    def rows(self) -> QuerySet[Slice]:
        return self.world.slices.select_related("created_by")


class Slices(SliceNoun, RowsRoute):
    """Lists the slices, and saves one."""

    sorts = {"name": "name", "id": "pk"}

    @extend_schema(request=NewSlice, responses={201: SliceSerializer})
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        sent = self.read(NewSlice)
        saved = save_slice(self.world, sent["name"], sent["query"], request.user)
        return RowRoute.show(self, saved, HTTPStatus.CREATED)


class OneSlice(SliceNoun, RowRoute):
    """Shows, renames and deletes a slice."""

    conditional_methods = ("PATCH", "DELETE")

    @extend_schema(request=SliceName, responses={200: SliceSerializer})
    def patch(self, request: Request, **kwargs: object) -> Response:
        with self.matching() as saved:
            rename_slice(saved, self.read(SliceName)["name"])
        return self.show(saved)

    def delete(self, request: Request, **kwargs: object) -> Response:
        with self.matching() as saved:
            delete_slice(saved)
        return Response(status=HTTPStatus.NO_CONTENT)
