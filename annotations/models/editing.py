"""What rows that people edit have in common: versions and history, drafts and comments."""

from __future__ import annotations

from datetime import datetime
from typing import Any, ClassVar, Protocol, runtime_checkable

from django.db import models
from django.db.models.signals import post_delete, post_save, pre_delete
from django.utils import timezone
from simple_history.models import HistoricalRecords

from annotations.models.people import User
from annotations.models.short_texts import ShortTextField
from annotations.models.worlds import Duty, World

NEW = "new"
MOST_CHARACTERS_OF_COMMENT = 4_000  # of a comment
LONGEST_DEVICE = 40  # the name of a browser
LONGEST_ABOUT = 200
LONGEST_PAGE = 500


class Records(HistoricalRecords):
    """The table of a model's history. ``annotations.rows.history`` writes it.

    The signals of django-simple-history are disconnected: they would write a row for each row of a
    world that is deleted, none for bulk writes, and guess the author.
    """

    def finalize(self, sender: type[models.Model], **kwargs: Any) -> None:
        super().finalize(sender, **kwargs)
        post_save.disconnect(self.post_save, sender=sender)
        post_delete.disconnect(self.post_delete, sender=sender)
        pre_delete.disconnect(self.pre_delete, sender=sender)


class HistoryEntry(Protocol):
    """A row of a table of history: the columns of its kind, and these."""

    id: int
    version: int
    history_id: int
    history_date: datetime
    history_type: str
    history_user: User | None
    history_change_reason: str | None

    @property
    def instance(self) -> Any:
        """The row of its kind as it was, unsaved."""


@runtime_checkable
class Placed(Protocol):
    """A row that has a place among others of its kind."""

    position: int | None


class Editable(models.Model):
    """A row that people edit. ``annotations.editing`` adds, changes, deletes and restores it.

    ``version`` counts from 1; whoever saves says which version they edited.

    ``world_path`` leads from the row to its world, as in a query. ``edited_fields`` are what people
    write, in the order of the page; ``fields_beside`` what is stored with them. A row that
    ``bears_on_commands`` is of a kind from which commands are generated, or their templates checked.
    """

    world_path: ClassVar[str] = "world"
    edited_fields: ClassVar[tuple[str, ...]] = ()
    fields_beside: ClassVar[tuple[str, ...]] = ()
    bears_on_commands: ClassVar[bool] = False

    version = models.PositiveIntegerField(default=1)
    history = Records(inherit=True)

    class Meta:
        abstract = True

    @property
    def owner(self) -> Any:
        """The world, or the grammar or ontology in it, that the row belongs to."""
        return getattr(self, self.world_path.split("__")[0])

    @property
    def owning_world(self) -> World:
        world: World = self.owner if isinstance(self.owner, World) else self.owner.world
        return world

    @property
    def makes_commands(self) -> bool:
        """Whether commands are generated from the row as it is, or their templates checked against it."""
        return self.bears_on_commands

    def note_editor(self, by: User) -> None:
        """Note in the row that ``by`` edits it, if it has a field for that."""


class Draft(models.Model):
    """The fields of a form about one row, as their author left them; nobody else sees them.

    ``subject`` is the key of the row, ``NEW`` for a new one, or either with a dash and a name behind it.
    ``base_version`` is the version that is edited, None for a new row. ``device`` tells the browsers of
    one person apart. ``about`` is what lists call it, and ``page`` the address of its form below that of the
    world, which may have another name later; both are empty where the browser did not say.
    """

    user = models.ForeignKey(User, on_delete=models.CASCADE, related_name="drafts")
    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="drafts")
    kind = models.CharField(max_length=20)
    subject = models.CharField(max_length=20)
    fields = models.JSONField(default=dict)
    base_version = models.PositiveIntegerField(null=True)
    device = models.CharField(max_length=LONGEST_DEVICE)
    about = ShortTextField(max_length=LONGEST_ABOUT, blank=True, default="")
    page = models.CharField(max_length=LONGEST_PAGE, blank=True, default="")
    saved_at = models.DateTimeField()

    class Meta:
        constraints = [
            models.UniqueConstraint(
                fields=["user", "world", "kind", "subject"], name="one_draft_each"
            )
        ]

    def __str__(self) -> str:
        return f"draft of {self.user}: {self.kind} {self.subject}"

    @property
    def key(self) -> str:
        """The name of its copy in a browser (``data-draft`` of the form)."""
        return f"{self.world_id}-{self.kind}-{self.subject}"

    @property
    def excerpt(self) -> str:
        """The beginning of the longest text that was typed."""
        texts = [text for name, text in self.fields.items() if name not in ("version", "once")]
        return max(texts, key=len, default="")[:LONGEST_ABOUT]


class CommentQuerySet(models.QuerySet["Comment"]):
    def present(self) -> CommentQuerySet:
        """Leave out those that are deleted."""
        return self.filter(deleted_at__isnull=True)


class Comment(models.Model):
    """``kind`` and ``subject``, a key, say what it is about (``annotations.editing.commenting``).

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
