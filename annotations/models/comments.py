"""What people say to each other about the rows of a world, and what of it waits for whom."""

from __future__ import annotations

from django.db import models
from django.utils import timezone

from annotations.models.people import User
from annotations.models.worlds import World

MOST_CHARACTERS = 4_000  # of a comment


class Comment(models.Model):
    """``kind`` and ``subject``, a key, say what it is about (``annotations.commenting.subjects``).

    ``about`` is the text of the subject at that time: logical forms are generated anew under other
    keys and found by it. ``subject`` is None where the row was gone when its world was moved.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="comments")
    kind = models.CharField(max_length=20)
    subject = models.PositiveBigIntegerField(null=True)
    about = models.TextField()
    author = models.ForeignKey(User, null=True, on_delete=models.SET_NULL)
    text = models.TextField(max_length=MOST_CHARACTERS)
    created_at = models.DateTimeField(default=timezone.now)

    class Meta:
        ordering = ["id"]
        indexes = [models.Index(fields=["world", "kind", "subject"])]

    def __str__(self) -> str:
        return self.text


class NoticeQuerySet(models.QuerySet["Notice"]):
    def of(self, user: User) -> NoticeQuerySet:
        """The notices of ``user`` in worlds that they still see."""
        worlds = World.objects.visible_to(user)
        return self.filter(user=user, comment__world__in=worlds)

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
