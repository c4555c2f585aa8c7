"""Verbs: comment on a row, tell those whom it concerns, mark as read."""

from __future__ import annotations

import re
from collections.abc import Iterable

from django.db import models, transaction
from django.utils import timezone

from annotations.commenting.subjects import SUBJECTS, Subject
from annotations.models import Comment, Notice, User, World

MOST_SHOWN = 100  # comments about one row, the newest
MOST_MENTIONS = 20  # people that one comment names
MENTION = re.compile(r"@([\w.@+-]+)")  # what Django allows in a name


def comments_on(world: World, subject: Subject, row: models.Model) -> list[Comment]:
    """Return the newest comments about ``row``, the oldest of them first; deleted ones are marked so."""
    rows = Comment.objects.filter(world=world, kind=subject.name)
    same = {"about": str(row)} if subject.is_known_by_text else {"subject": row.pk}
    rows = rows.filter(**same).select_related("author", "deleted_by")
    newest = rows.prefetch_related("earlier_texts").order_by("-id")[:MOST_SHOWN]
    return list(newest)[::-1]


def add_comment(world: World, subject: Subject, row: models.Model, text: str, by: User) -> Comment:
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
