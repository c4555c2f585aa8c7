"""A message that offers to undo what it says."""

from __future__ import annotations

from django.contrib import messages
from django.middleware.csrf import get_token
from django.urls import reverse
from django.utils.html import format_html, format_html_join

from annotations.models import World
from annotations.people.access import PageRequest
from annotations.rows.row_kinds import EditableKind
from annotations.showing.keys import KEYS


def say_with_undo(request: PageRequest, sentence: str, address: str, **fields: object) -> None:
    """Show ``sentence`` on the next page, with a button “Undo” that posts ``fields`` to ``address``."""
    values = {"csrfmiddlewaretoken": get_token(request), **fields}
    hidden = format_html_join("", '<input type="hidden" name="{}" value="{}">', values.items())
    undo = format_html(
        '<form method="post" action="{}">{}<button type="submit" class="small-button" '
        'data-page-action="undo" aria-keyshortcuts="{}">Undo</button></form>',
        address,
        hidden,
        KEYS["undo"].keys[0],
    )
    messages.success(request, format_html("{} {}", sentence, undo))


def say_deleted(request: PageRequest, world: World, kind: EditableKind, pk: int) -> None:
    """Show that a row was deleted, with a button that restores it, and where it stands later."""
    entry = kind.entries_of(world).filter(id=pk).first()
    history = reverse("history", kwargs={"world": world.name, "kind": kind.name, "pk": pk})
    sentence = f"Deleted. “Deleted {kind.plural}” below the list brings it back."
    say_with_undo(request, sentence, history, entry=entry and entry.history_id)
