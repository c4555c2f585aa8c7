"""Verbs: comment on a row of a world, mention its members, edit, delete and restore a comment, read the inbox."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime
from http import HTTPStatus
from itertools import pairwise
from typing import Any

from django.db import models, transaction
from django.http import Http404
from django.urls import reverse
from django.utils import timezone

from annotations.language.texts import Refusal
from annotations.models import Comment, EarlierText, LogicalForm, Notice, User, World
from annotations.rows.row_kinds import KINDS
from annotations.showing.form_presentation import Pieces, compare

MOST_SHOWN = 100  # comments about one row, the newest
MOST_MENTIONS = 20  # people that one comment names
MENTION = re.compile(r"@([\w.@+-]+)")  # what Django allows in a name


@dataclass(frozen=True, slots=True)
class CommentSubject:
    """A kind of row with the ``name`` that stands in addresses.

    ``page`` is the route of one row, with its key, that shows its comments; empty where only the
    page of comments does. A row ``is_known_by_text`` where it is generated anew under other keys.
    """

    name: str
    model: type[models.Model]
    world_path: str
    page: str = ""
    is_known_by_text: bool = False

    def row(self, world: World, pk: int) -> models.Model:
        """Return a row of ``world``. Raises Http404."""
        rows = self.model._default_manager.filter(**{self.world_path: world})
        if row := rows.filter(pk=pk).first():
            return row
        raise Http404(f"There is no such {self.name}.")

    def address(self, world: World, pk: int) -> str:
        """Return the page that shows a row with its comments."""
        if self.page:
            return reverse(self.page, kwargs={"world": world.name, "pk": pk}) + "#comments"
        return reverse("comments", kwargs={"world": world.name, "kind": self.name, "pk": pk})

    def current_key(self, comment: Comment) -> int | None:
        """Return the key of what ``comment`` is about; None where it is gone."""
        rows = self.model._default_manager.filter(**{self.world_path: comment.world_id})
        named: dict[str, Any] = {"pk": comment.subject}
        if self.is_known_by_text:
            named = {"text": comment.about}
        return rows.filter(**named).values_list("pk", flat=True).first()


SUBJECTS = {
    subject.name: subject
    for subject in (
        *(
            CommentSubject(kind.name, kind.model, kind.model.world_path, kind.page)
            for kind in KINDS.values()
        ),
        CommentSubject("form", LogicalForm, "world", "logical_form", is_known_by_text=True),
    )
}


def comments_on(world: World, subject: CommentSubject, row: models.Model) -> list[Comment]:
    """Return the newest comments about ``row``, the oldest of them first; deleted ones are marked so."""
    rows = Comment.objects.filter(world=world, kind=subject.name)
    same = {"about": str(row)} if subject.is_known_by_text else {"subject": row.pk}
    rows = rows.filter(**same).select_related("author", "deleted_by")
    newest = rows.prefetch_related("earlier_texts").order_by("-id")[:MOST_SHOWN]
    return list(newest)[::-1]


def add_comment(
    world: World, subject: CommentSubject, row: models.Model, text: str, by: User
) -> Comment:
    """Store what ``by`` says about ``row``; it waits in the inbox of those it names or answers.

    Members are named as ``@name``. Whoever has commented on the row before is answered.
    """
    with transaction.atomic():
        comment = Comment.objects.create(
            world=world, kind=subject.name, subject=row.pk, about=str(row), author=by, text=text
        )
        members = {user.pk: user for user in people_of(world)}
        mentioned = {user.pk for user in mentioned_in(text, members.values())}
        answered = authors_before(comment) & members.keys()
        notices = [
            Notice(comment=comment, user_id=pk, is_mention=pk in mentioned)
            for pk in sorted((mentioned | answered) - {by.pk})
        ]
        Notice.objects.bulk_create(notices)
    return comment


def mentioned_in(text: str, people: Iterable[User]) -> list[User]:
    """Return those of ``people`` whom ``text`` names, at most ``MOST_MENTIONS``, in the order of the text."""
    by_name = {user.get_username().casefold(): user for user in people}
    mentioned: dict[int, User] = {}
    for name in MENTION.findall(text):
        # A full stop may end the sentence.
        user = by_name.get(name.casefold()) or by_name.get(name.rstrip(".-").casefold())
        if user and len(mentioned) < MOST_MENTIONS:
            mentioned[user.pk] = user
    return list(mentioned.values())


def people_of(world: World) -> models.QuerySet[User]:
    """Return the members of ``world`` who can log in, by name: whom a comment can mention."""
    members = User.objects.filter(memberships__world=world, is_active=True)
    return members.distinct().order_by("username")


def authors_before(comment: Comment) -> set[int]:
    """Return the keys of those who have commented before ``comment`` on the same row."""
    is_known_by_text = SUBJECTS[comment.kind].is_known_by_text
    same = {"about": comment.about} if is_known_by_text else {"subject": comment.subject}
    earlier = Comment.objects.present().filter(
        world=comment.world_id, kind=comment.kind, pk__lt=comment.pk, **same
    )
    authors = earlier.exclude(author=None).order_by().values_list("author", flat=True)
    return set(authors.distinct())


def mark_read(notices: models.QuerySet[Notice]) -> int:
    """Take ``notices`` out of what waits; return how many did."""
    return notices.filter(read_at__isnull=True).update(read_at=timezone.now())


class EditedElsewhere(Refusal):
    """The comment is at another version than the one that was edited, or deleted; nothing was saved.

    ``current`` is the comment as it is now.
    """

    code = "edited_elsewhere"
    status = HTTPStatus.CONFLICT

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
        # Notices follow the text; nobody is told of one mention twice.
        mentioned = {user.pk for user in mentioned_in(stored.text, people_of(stored.world))}
        mentioned.discard(stored.author_id)
        known = set(stored.notices.values_list("user", flat=True))
        stored.notices.filter(user__in=mentioned, is_mention=False).update(
            is_mention=True, read_at=None
        )
        dropped = stored.notices.unread().filter(is_mention=True).exclude(user__in=mentioned)
        answered = authors_before(stored)
        dropped.exclude(user__in=answered).delete()
        dropped.filter(user__in=answered).update(is_mention=False)
        Notice.objects.bulk_create(
            Notice(comment=stored, user_id=pk, is_mention=True) for pk in sorted(mentioned - known)
        )
    return stored


def delete_comment(comment: Comment, by: User) -> None:
    """Hide ``comment`` everywhere, inboxes included, until it is restored."""
    rows = Comment.objects.present().filter(pk=comment.pk)
    rows.update(deleted_at=timezone.now(), deleted_by=by)


def restore_comment(comment: Comment) -> None:
    """Show a deleted comment again, also in the inboxes where it was."""
    Comment.objects.filter(pk=comment.pk).update(deleted_at=None, deleted_by=None)


@dataclass(frozen=True, slots=True)
class CommentVersion:
    """``pieces`` mark what changed since the version before."""

    number: int
    text: str
    written_at: datetime
    pieces: Pieces


def versions_of(comment: Comment) -> list[CommentVersion]:
    """Return the versions of ``comment``, the newest first."""
    texts = [(each.text, each.written_at) for each in comment.earlier_texts.all()]
    texts.append((comment.text, comment.edited_at or comment.created_at))
    first, at = texts[0]
    versions = [CommentVersion(1, first, at, [("same", first)])]
    for (before, _), (text, moment) in pairwise(texts):
        _, pieces = compare(before, text, False)
        versions.append(CommentVersion(len(versions) + 1, text, moment, pieces))
    return versions[::-1]
