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


@register.simple_tag
def ask_with(form: str, url: str, trigger: str) -> SafeString:
    """Return the attributes of an element that is replaced by what ``url`` answers to the fields of the
    form with the id ``form``, whenever ``trigger`` says so."""
    return format_html(
        'hx-post="{}" hx-include="#{}" hx-trigger="{}" hx-swap="outerHTML"', url, form, trigger
    )
