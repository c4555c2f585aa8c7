"""A message that offers to undo what it says."""

from __future__ import annotations

from django.contrib import messages
from django.middleware.csrf import get_token
from django.utils.html import format_html, format_html_join

from annotations.people.access import PageRequest


def say_with_undo(request: PageRequest, sentence: str, address: str, **fields: object) -> None:
    """Show ``sentence`` on the next page, with a button “Undo” that posts ``fields`` to ``address``."""
    values = {"csrfmiddlewaretoken": get_token(request), **fields}
    hidden = format_html_join("", '<input type="hidden" name="{}" value="{}">', values.items())
    undo = format_html(
        '<form method="post" action="{}">{}<button type="submit" class="small-button">Undo'
        "</button></form>",
        address,
        hidden,
    )
    messages.success(request, format_html("{} {}", sentence, undo))
