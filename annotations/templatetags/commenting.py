"""Template tags: the comments on a row, and how a comment is written."""

from __future__ import annotations

from typing import Any

from django import template
from django.utils.html import format_html, format_html_join
from django.utils.safestring import SafeString

from annotations.commenting import SUBJECTS, comments_on, people_of
from annotations.commenting.comments import MENTION
from annotations.forms import CommentForm

register = template.Library()

MOST_NAMES = 20  # members offered beside the field


@register.inclusion_tag("annotations/_comments.html", takes_context=True)
def comments_section(context: Any, kind: str, row: Any, form: Any = None) -> dict[str, Any]:
    """Show the comments on ``row``, a subject of that ``kind``, and the field for one more."""
    world = context["world"]
    return {
        "request": context["request"],
        "csrf_token": context.get("csrf_token"),
        "world": world,
        "kind": kind,
        "row": row,
        "comments": comments_on(world, SUBJECTS[kind], row),
        "people": people_of(world).exclude(pk=context["request"].user.pk)[:MOST_NAMES],
        "form": form or CommentForm(),
    }


@register.filter
def with_mentions(text: str) -> SafeString:
    """Write a comment with the names it mentions in bold."""
    parts = MENTION.split(text)
    marked = (
        format_html("<strong>@{}</strong>" if at % 2 else "{}", part)
        for at, part in enumerate(parts)
    )
    return format_html_join("", "{}", ((part,) for part in marked))
