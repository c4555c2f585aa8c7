"""What pages call a parser and what it learns from; the sign of one with a footnote, and the footnote."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from django import template
from django.utils.html import format_html
from django.utils.safestring import SafeString

from parser_service.parsers.conditions import in_short, in_words
from parser_service.parsers.registry import title_of
from parser_service.results.table_parts import MARK, MAY_KNOW_CORPORA, may_know_corpora

register = template.Library()
NOTHING = SafeString()


@register.filter
def parser_title(parser: str) -> str:
    """Return what pages call a parser, by its name in the registry: ``Nearest neighbour`` for ``knn``."""
    return title_of(parser)


@register.filter
def sources_in_words(sources: str) -> str:
    """Say what is trained on: ``generated commands and paraphrases`` for ``gen+para``."""
    return in_words(sources)


@register.filter
def sources_in_short(sources: str) -> str:
    """Say what is tested on as heads of results do: ``paraphrases`` for ``para``, ``both`` for ``mixed``."""
    return in_short(sources)


@register.simple_tag
def mark(parser: str) -> SafeString:
    """Return the sign of a parser, by its name; empty if its figures need no footnote."""
    if not may_know_corpora(parser):
        return NOTHING
    return format_html('<sup><abbr title="{}">{}</abbr></sup>', MAY_KNOW_CORPORA, MARK)


def _parser_of(row: Any) -> str:
    return str(getattr(row, "run", row).parser)


@register.simple_tag
def footnote(shown: str | Iterable[Any]) -> SafeString:
    """Return the footnote if anything ``shown`` bears the sign: a parser, by its name, or rows, each
    of a run or a parser."""
    parsers = [shown] if isinstance(shown, str) else map(_parser_of, shown)
    if not any(map(may_know_corpora, parsers)):
        return NOTHING
    return format_html('<p class="quiet small">{} {}</p>', MARK, MAY_KNOW_CORPORA)
