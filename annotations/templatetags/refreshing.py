"""Template tag: parts of a page that ask for themselves again."""

from __future__ import annotations

from django import template
from django.utils.html import format_html
from django.utils.safestring import SafeString

register = template.Library()


@register.simple_tag
def refresh_every(seconds: int, url: str) -> SafeString:
    """Return the attributes of an element that is replaced by what ``url`` answers, if that differs."""
    return format_html(
        'hx-get="{}" hx-trigger="every {}s" hx-swap="outerHTML" data-swap-if-changed', url, seconds
    )
