"""What waits in one's inbox: comments that name one, or answer where one has written."""

from __future__ import annotations

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.commenting import mark_read
from annotations.models import Notice
from annotations.web.editing.comment_rest import CommentSerializer
from annotations.web.rest.routes import ManyRows, Route, SingleRow


class NoticeSerializer(serializers.ModelSerializer):
    """A comment that waits for the caller, until it is read."""

    world = serializers.CharField(source="comment.world.name")
    comment = CommentSerializer()

    class Meta:
        model = Notice
        fields = ["id", "world", "comment", "is_mention", "read_at"]


class CountSerializer(serializers.Serializer):
    read = serializers.IntegerField()


class NoticeNoun:
    model = Notice
    serializer_class = NoticeSerializer

    def rows(self) -> QuerySet[Notice]:
        rows = Notice.objects.of(self.request.user)
        return rows.select_related("comment__world", "comment__author")


class Notices(NoticeNoun, ManyRows):
    """Lists what waits for the caller in all their worlds, the newest first."""

    filter_backends = []
    sorts = {"newest": "-pk"}


class ReadNotices(NoticeNoun, Route):
    """Marks everything as read."""

    http_method_names = ["post", "options"]

    @extend_schema(operation_id="notices_read", request=None, responses={200: CountSerializer})
    def post(self, request: Request) -> Response:
        return Response({"read": mark_read(Notice.objects.of(request.user))})


class ReadNotice(NoticeNoun, SingleRow):
    """Marks one notice as read."""

    http_method_names = ["post", "options"]

    @extend_schema(request=None, responses={200: NoticeSerializer})
    def post(self, request: Request, **kwargs: object) -> Response:
        mark_read(Notice.objects.filter(pk=self.get_object().pk))
        return self.show(self.get_object())
