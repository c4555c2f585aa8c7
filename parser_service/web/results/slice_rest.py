"""Saved slices of predictions."""

from __future__ import annotations

from http import HTTPStatus

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.models import Duty
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import RowsViewSet
from parser_service.models import Slice
from parser_service.models.reviews import LONGEST_SLICE_NAME
from parser_service.results.saving import delete_slice, rename_slice, save_slice

LONGEST_QUERY = 5_000


class SliceSerializer(serializers.ModelSerializer[Slice]):
    """A saved filter over predictions; ``query`` holds parameters of a list of predictions."""

    created_by = serializers.CharField(source="created_by.username", default=None)

    class Meta:
        model = Slice
        fields = ["id", "name", "query", "created_by", "created_at"]


class SliceName(Fields):
    name = LineField(max_length=LONGEST_SLICE_NAME)


class NewSlice(SliceName):
    query = LineField(max_length=LONGEST_QUERY)


class SliceViewSet(RowsViewSet):
    """The saved slices."""

    model = Slice
    serializer_class = SliceSerializer
    duties = dict.fromkeys(("create", "partial_update", "destroy"), Duty.REVIEW)
    conditional = ("partial_update", "destroy")
    sorts = {"name": "name", "id": "pk"}

    def rows(self) -> QuerySet[Slice]:
        return self.world.slices.select_related("created_by")

    @extend_schema(request=NewSlice, responses={201: SliceSerializer})
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Saves a slice."""
        sent = self.read(NewSlice)
        saved = save_slice(self.world, sent["name"], sent["query"], request.user)
        return self.show(saved, HTTPStatus.CREATED)

    @extend_schema(request=SliceName, responses={200: SliceSerializer})
    def partial_update(self, request: ApiRequest, **kwargs: object) -> Response:
        """Renames a slice."""
        with self.matching() as saved:
            rename_slice(saved, self.read(SliceName)["name"])
        return self.show(saved)

    def destroy(self, request: ApiRequest, **kwargs: object) -> Response:
        """Deletes a slice."""
        with self.matching() as saved:
            delete_slice(saved)
        return Response(status=HTTPStatus.NO_CONTENT)
