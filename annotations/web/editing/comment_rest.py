"""Comments on rows."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.db.models import QuerySet
from django.http import Http404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.exceptions import PermissionDenied
from rest_framework.response import Response

from annotations.editing.commenting import (
    SUBJECTS,
    add_comment,
    change_comment,
    delete_comment,
    restore_comment,
)
from annotations.language.texts import Refusal
from annotations.models import Comment, User
from annotations.models.editing import MOST_CHARACTERS_OF_COMMENT
from annotations.web.editing.comment_forms import COMMENTS, TOO_MANY
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import Retrieved, RowsRoute, WorldViewSet


class CommentSerializer(serializers.ModelSerializer[Comment]):
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


def count(by: User) -> None:
    """Count one comment of somebody. Raises Refusal where they have written many within minutes."""
    if COMMENTS.take(str(by.pk)) is None:
        raise Refusal(TOO_MANY, "too_many_comments", HTTPStatus.TOO_MANY_REQUESTS)


class Comments(RowsRoute):
    """Lists the comments on a row, the oldest first, and adds one."""

    model = Comment
    serializer_class = CommentSerializer

    def _subject(self) -> Any:
        if self.kwargs["kind"] not in SUBJECTS:
            raise Http404("There are no comments on such rows.")
        return SUBJECTS[self.kwargs["kind"]]

    def rows(self) -> QuerySet[Comment]:
        subject = self._subject()
        row = subject.row(self.world, self.kwargs["pk"])
        same = {"about": str(row)} if subject.is_known_by_text else {"subject": row.pk}
        comments = self.world.comments.present().select_related("author", "world")
        return comments.filter(kind=subject.name, **same)

    @extend_schema(request=CommentText, responses={201: CommentSerializer})
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        subject = self._subject()
        row = subject.row(self.world, self.kwargs["pk"])
        text = self.read(CommentText)["text"]
        count(request.user)
        made = add_comment(self.world, subject, row, text, request.user)
        return self.show(made, HTTPStatus.CREATED)


class CommentViewSet(Retrieved, WorldViewSet):
    """A comment. Its author edits it, and an admin may delete it too."""

    model = Comment
    serializer_class = CommentSerializer
    conditional = ("partial_update", "destroy")

    def rows(self) -> QuerySet[Comment]:
        comments = self.world.comments.select_related("author", "world")
        return comments if self.action == "restore" else comments.present()

    @extend_schema(request=CommentText, responses={200: CommentSerializer})
    def partial_update(self, request: ApiRequest, **kwargs: object) -> Response:
        """Edits a comment of the caller."""
        row = self.get_object()
        if not row.may_be_edited_by(request.user):
            raise PermissionDenied("Only the author of a comment edits it.")
        text = self.read(CommentText)["text"]
        with self.matching() as row:
            count(request.user)
            changed = change_comment(row, text, row.version)
        return self.show(changed)

    def destroy(self, request: ApiRequest, **kwargs: object) -> Response:
        """Deletes a comment; ``restore/`` brings it back."""
        row = self.get_object()
        if not row.may_be_deleted_by(request.user, self.world.duties_of(request.user)):
            raise PermissionDenied("Only its author and the admins of this world delete a comment.")
        with self.matching() as row:
            delete_comment(row, request.user)
        return Response(status=HTTPStatus.NO_CONTENT)

    @extend_schema(request=None, responses={200: CommentSerializer})
    @action(detail=True, methods=["post"])
    def restore(self, request: ApiRequest, **kwargs: object) -> Response:
        """Brings a deleted comment back."""
        row = self.get_object()
        if row.is_deleted:
            if not row.may_be_restored_by(request.user, self.world.duties_of(request.user)):
                raise PermissionDenied("Only who deleted a comment restores it.")
            restore_comment(row)
        return self.show(self.get_object())
