"""Verbs: edit, delete and restore a comment. Nothing that it said is lost."""

from __future__ import annotations

from django.db import transaction
from django.utils import timezone

from annotations.commenting.comments import authors_before, mentioned_in, people_of
from annotations.models import Comment, EarlierText, Notice, User


class EditedElsewhere(Exception):
    """The comment is at another version than the one that was edited, or deleted; nothing was saved.

    ``current`` is the comment as it is now.
    """

    def __init__(self, current: Comment) -> None:
        what = "deleted" if current.is_deleted else "edited"
        super().__init__(f"This comment has been {what} in the meantime.")
        self.current = current


def change_comment(comment: Comment, text: str, version: int) -> Comment:
    """Let ``comment``, which its author edited at ``version``, say ``text``; what it said is kept.

    Whoever is mentioned now, and was not before, gets it into the inbox; whoever is not any more loses
    it there unless they have read it. Raises EditedElsewhere.
    """
    with transaction.atomic():
        stored = Comment.objects.select_for_update(of=("self",)).get(pk=comment.pk)
        if stored.is_deleted or (stored.version != version and stored.text != text):
            raise EditedElsewhere(stored)
        if stored.text == text:
            return stored
        began = stored.edited_at or stored.created_at
        EarlierText.objects.create(comment=stored, text=stored.text, written_at=began)
        stored.text, stored.edited_at = text, timezone.now()
        stored.version += 1
        stored.save(update_fields=["text", "edited_at", "version"])
        _update_mentions(stored)
    return stored


def delete_comment(comment: Comment, by: User) -> None:
    """Hide ``comment`` everywhere, inboxes included, until it is restored."""
    rows = Comment.objects.present().filter(pk=comment.pk)
    rows.update(deleted_at=timezone.now(), deleted_by=by)


def restore_comment(comment: Comment) -> None:
    """Show a deleted comment again, also in the inboxes where it was."""
    Comment.objects.filter(pk=comment.pk).update(deleted_at=None, deleted_by=None)


def _update_mentions(comment: Comment) -> None:
    """Bring the notices up to date with the text; nobody is told of one mention twice."""
    mentioned = {user.pk for user in mentioned_in(comment.text, people_of(comment.world))}
    mentioned.discard(comment.author_id)
    known = set(comment.notices.values_list("user", flat=True))
    comment.notices.filter(user__in=mentioned, is_mention=False).update(
        is_mention=True, read_at=None
    )
    dropped = comment.notices.unread().filter(is_mention=True).exclude(user__in=mentioned)
    answered = authors_before(comment)
    dropped.exclude(user__in=answered).delete()
    dropped.filter(user__in=answered).update(is_mention=False)
    Notice.objects.bulk_create(
        Notice(comment=comment, user_id=pk, is_mention=True) for pk in sorted(mentioned - known)
    )
