"""Template filter: an utterance as it was heard."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from django import template
from django.utils.html import format_html, format_html_join
from django.utils.safestring import SafeString

from parser_service.web.serving.heard_pieces import HeardPiece

register = template.Library()


@register.filter
def heard(pieces: Iterable[HeardPiece]) -> SafeString:
    """Show an utterance with the words that name an entity marked by its class, and those struck that were heard
    otherwise, before what was heard."""
    return format_html_join("", "{}", ((_mark(piece),) for piece in pieces))


@register.filter
def as_percent(probability: float) -> int:
    """Show how sure an answer is, 1 to 99."""
    # Not before a page shows one: it needs NumPy.
    from parser_service.analysis.sureness import percent_of

    return percent_of(probability)


def _mark(piece: HeardPiece) -> SafeString | str:
    if piece.entity_class:
        return format_html(
            '<span class="chip" data-class="{0}" title="{2}"><span class="value">{1}</span>{0}</span>',
            piece.entity_class,
            piece.text,
            piece.value,
        )
    if not piece.why:
        return piece.text
    return format_html_join(" ", "{}", ((mark,) for mark in _marks_of_change(piece)))


def _marks_of_change(piece: HeardPiece) -> Iterator[SafeString]:
    if piece.text:
        yield format_html('<del title="{}">{}</del>', piece.why, piece.text)
    if piece.heard:
        yield format_html('<ins title="{}">{}</ins>', piece.why, piece.heard)
