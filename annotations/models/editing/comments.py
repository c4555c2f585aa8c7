"""What people say to each other about the rows of a world, and what of it waits for whom."""

from __future__ import annotations

from django.db import models
from django.utils import timezone

from annotations.models.people import User
from annotations.models.worlds import Duty, World

MOST_CHARACTERS_OF_COMMENT = 4_000  # of a comment


class CommentQuerySet(models.QuerySet["Comment"]):
    def present(self) -> CommentQuerySet:
        """Leave out those that are deleted."""
        return self.filter(deleted_at__isnull=True)


class Comment(models.Model):
    """``kind`` and ``subject``, a key, say what it is about (``annotations.commenting.subjects``).

    ``about`` is the text of the subject at that time: logical forms are generated anew under other
    keys and found by it. ``subject`` is None where the row was gone when its world was moved.
    ``version`` counts from 1; what the comment said before stands in its earlier texts. One that is
    deleted stays a row, so that it can be restored.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="comments")
    kind = models.CharField(max_length=20)
    subject = models.PositiveBigIntegerField(null=True)
    about = models.TextField()
    author = models.ForeignKey(User, null=True, on_delete=models.SET_NULL)
    text = models.TextField(max_length=MOST_CHARACTERS_OF_COMMENT)
    version = models.PositiveIntegerField(default=1)
    created_at = models.DateTimeField(default=timezone.now)
    edited_at = models.DateTimeField(null=True, default=None)
    deleted_at = models.DateTimeField(null=True, default=None)
    deleted_by = models.ForeignKey(
        User, null=True, default=None, on_delete=models.SET_NULL, related_name="comments_deleted"
    )

    objects = CommentQuerySet.as_manager()

    class Meta:
        ordering = ["id"]
        indexes = [models.Index(fields=["world", "kind", "subject"])]

    def __str__(self) -> str:
        return self.text

    @property
    def is_deleted(self) -> bool:
        return self.deleted_at is not None

    def may_be_edited_by(self, user: User) -> bool:
        return self.author_id == user.pk and not self.is_deleted

    def may_be_deleted_by(self, user: User, duties: frozenset[Duty]) -> bool:
        is_allowed = self.author_id == user.pk or Duty.MANAGE in duties
        return is_allowed and not self.is_deleted

    def may_be_restored_by(self, user: User, duties: frozenset[Duty]) -> bool:
        """Return whether ``user`` may: who deleted it, or any admin where an admin did."""
        is_of_admins = self.deleted_by_id != self.author_id and Duty.MANAGE in duties
        return self.is_deleted and (self.deleted_by_id == user.pk or is_of_admins)


class EarlierText(models.Model):
    """What a comment said before its author edited it; ``written_at`` is when it began to."""

    comment = models.ForeignKey(Comment, on_delete=models.CASCADE, related_name="earlier_texts")
    text = models.TextField()
    written_at = models.DateTimeField()

    class Meta:
        ordering = ["id"]

    def __str__(self) -> str:
        return self.text


class NoticeQuerySet(models.QuerySet["Notice"]):
    def of(self, user: User) -> NoticeQuerySet:
        """Return the notices of ``user`` in worlds that they still see, of comments that are there."""
        comments = Comment.objects.present().filter(world__in=World.objects.visible_to(user))
        return self.filter(user=user, comment__in=comments)

    def unread(self) -> NoticeQuerySet:
        return self.filter(read_at__isnull=True)


class Notice(models.Model):
    """A comment that waits in somebody's inbox: it mentions them, or answers where they have written."""

    comment = models.ForeignKey(Comment, on_delete=models.CASCADE, related_name="notices")
    user = models.ForeignKey(User, on_delete=models.CASCADE, related_name="notices")
    is_mention = models.BooleanField()
    read_at = models.DateTimeField(null=True)

    objects = NoticeQuerySet.as_manager()

    class Meta:
        ordering = ["-id"]
        constraints = [models.UniqueConstraint(fields=["comment", "user"], name="one_notice_each")]
        indexes = [models.Index(fields=["user", "read_at", "-id"])]

    def __str__(self) -> str:
        return f"{self.user}: {self.comment}"
