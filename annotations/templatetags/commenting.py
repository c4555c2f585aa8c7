"""Template tags: the comments on a row, and how a comment is written."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from django import template
from django.utils.html import format_html, format_html_join
from django.utils.safestring import SafeString

from annotations.editing.commenting import MENTION, SUBJECTS, comments_on, people_of
from annotations.models import Comment
from annotations.web.editing.comment_forms import CommentForm

register = template.Library()

MOST_NAMES = 20  # members offered beside the field


@register.inclusion_tag("annotations/editing/_comments.html", takes_context=True)
def comments_section(context: Any, kind: str, row: Any, form: Any = None) -> dict[str, Any]:
    """Show the comments on ``row``, a subject of that ``kind``, and the field for one more."""
    world, request = context["world"], context["request"]
    comments = comments_on(world, SUBJECTS[kind], row)
    user, duties = request.user, request.duties
    return {
        "request": request,
        "csrf_token": context.get("csrf_token"),
        "world": world,
        "kind": kind,
        "row": row,
        "comments": comments,
        "count": sum(not each.is_deleted for each in comments),
        "shown": [
            ShownComment(each, each.may_be_edited_by(user), each.may_be_deleted_by(user, duties))
            for each in comments
            if not each.is_deleted or each.may_be_restored_by(user, duties)
        ],
        "people": people_of(world).exclude(pk=request.user.pk)[:MOST_NAMES],
        "form": form or CommentForm(),
    }


@dataclass(frozen=True, slots=True)
class ShownComment:
    """A comment with what the reader may do about it."""

    comment: Comment
    may_edit: bool
    may_delete: bool


@register.filter
def with_mentions(text: str) -> SafeString:
    """Write a comment with the names it mentions in bold."""
    parts = MENTION.split(text)
    marked = (
        format_html("<strong>@{}</strong>" if at % 2 else "{}", part)
        for at, part in enumerate(parts)
    )
    return format_html_join("", "{}", ((part,) for part in marked))
