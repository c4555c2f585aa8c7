"""The caller's inbox: comments that mention them, and those on rows that they have commented on."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.mixins import ListModelMixin
from rest_framework.response import Response

from annotations.editing.commenting import mark_read
from annotations.models import Notice
from annotations.web.editing.comment_rest import CommentSerializer
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import SiteViewSet


class NoticeSerializer(serializers.ModelSerializer[Notice]):
    """A comment that waits for the caller, until it is read."""

    world = serializers.CharField(source="comment.world.name")
    comment = CommentSerializer()

    class Meta:
        model = Notice
        fields = ["id", "world", "comment", "is_mention", "read_at"]


class CountSerializer(serializers.Serializer[Any]):
    read = serializers.IntegerField()


class NoticeViewSet(ListModelMixin, SiteViewSet):
    """What waits for the caller in all their worlds, the newest first."""

    model = Notice
    serializer_class = NoticeSerializer
    filter_backends = []
    sorts = {"newest": "-pk"}
    unrecorded = ("read_all", "read_one")

    def rows(self) -> QuerySet[Notice]:
        rows = Notice.objects.of(self.request.user)
        return rows.select_related("comment__world", "comment__author")

    @extend_schema(operation_id="notices_read", request=None, responses={200: CountSerializer})
    @action(detail=False, methods=["post"], url_path="read", url_name="read-all")
    def read_all(self, request: ApiRequest) -> Response:
        """Marks everything as read."""
        return Response({"read": mark_read(Notice.objects.of(request.user))})

    @extend_schema(request=None, responses={200: NoticeSerializer})
    @action(detail=True, methods=["post"], url_path="read", url_name="read")
    def read_one(self, request: ApiRequest, **kwargs: object) -> Response:
        """Marks one notice as read."""
        mark_read(Notice.objects.filter(pk=self.get_object().pk))
        return self.show(self.get_object())
