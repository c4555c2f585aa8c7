"""Comments on rows."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any, ClassVar

from django.db.models import QuerySet
from django.http import Http404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.exceptions import PermissionDenied
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.commenting import (
    SUBJECTS,
    add_comment,
    change_comment,
    delete_comment,
    restore_comment,
)
from annotations.models import Comment
from annotations.models.editing import MOST_CHARACTERS_OF_COMMENT
from annotations.web.editing.comment_forms import COMMENTS, TOO_MANY
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.problem_details import Refused
from annotations.web.rest.routes import RowRoute, RowsRoute


class CommentSerializer(serializers.ModelSerializer):
    """What somebody said about a row of a kind; ``about`` is what the row said then."""

    author = serializers.CharField(source="author.username", default=None)

    class Meta:
        model = Comment
        fields = [
            *("id", "kind", "subject", "about", "author", "text"),
            *("version", "created_at", "edited_at"),
        ]


class CommentText(Fields):
    """Write ``@name`` to reach a member of the world."""

    text = serializers.CharField(max_length=MOST_CHARACTERS_OF_COMMENT)


class CommentNoun:
    model = Comment
    serializer_class = CommentSerializer

    def rows(self) -> QuerySet[Comment]:
        return self.world.comments.present().select_related("author", "world")

    def count(self) -> None:
        """Count one comment of the caller. Raises Refused where they have written many within minutes."""
        if COMMENTS.take(str(self.request.user.pk)) is None:
            raise Refused(TOO_MANY, status=HTTPStatus.TOO_MANY_REQUESTS)


class Comments(CommentNoun, RowsRoute):
    """Lists the comments on a row, the oldest first, and adds one."""

    def _subject(self) -> Any:
        if self.kwargs["kind"] not in SUBJECTS:
            raise Http404("There are no comments on such rows.")
        return SUBJECTS[self.kwargs["kind"]]

    def rows(self) -> QuerySet[Comment]:
        subject = self._subject()
        row = subject.row(self.world, self.kwargs["pk"])
        same = {"about": str(row)} if subject.is_known_by_text else {"subject": row.pk}
        return super().rows().filter(kind=subject.name, **same)

    @extend_schema(request=CommentText, responses={201: CommentSerializer})
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        subject = self._subject()
        row = subject.row(self.world, self.kwargs["pk"])
        text = self.read(CommentText)["text"]
        self.count()
        made = add_comment(self.world, subject, row, text, request.user)
        return RowRoute.show(self, made, HTTPStatus.CREATED)


class OneComment(CommentNoun, RowRoute):
    """Shows a comment; its author edits it, and an admin may delete it too."""

    conditional: ClassVar[tuple[str, ...]] = ("PATCH", "DELETE")

    @extend_schema(request=CommentText, responses={200: CommentSerializer})
    def patch(self, request: Request, **kwargs: object) -> Response:
        row = self.get_object()
        if not row.may_be_edited_by(request.user):
            raise PermissionDenied("Only the author of a comment edits it.")
        text = self.read(CommentText)["text"]
        with self.matching() as row:
            self.count()
            changed = change_comment(row, text, row.version)
        return self.show(changed)

    def delete(self, request: Request, **kwargs: object) -> Response:
        row = self.get_object()
        if not row.may_be_deleted_by(request.user, self.world.duties_of(request.user)):
            raise PermissionDenied("Only its author and the admins of this world delete a comment.")
        with self.matching() as row:
            delete_comment(row, request.user)
        return Response(status=HTTPStatus.NO_CONTENT)


class RestoreComment(CommentNoun, RowRoute):
    """Brings a deleted comment back."""

    http_method_names = ["post", "options"]

    def rows(self) -> QuerySet[Comment]:
        return self.world.comments.select_related("author", "world")

    @extend_schema(request=None, responses={200: CommentSerializer})
    def post(self, request: Request, **kwargs: object) -> Response:
        row = self.get_object()
        if row.is_deleted:
            if not row.may_be_restored_by(request.user, self.world.duties_of(request.user)):
                raise PermissionDenied("Only who deleted a comment restores it.")
            restore_comment(row)
        return self.show(self.get_object())
